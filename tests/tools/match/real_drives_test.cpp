// Tests links found on eight recorded drives against labels of the links driven. The bounds are the
// results of maploop experiment match and map-faults, with a margin.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <sstream>

#include "mapmatch/map_area.h"
#include "mapmatch/network_file.h"
#include "msgs/frames.h"
#include "tests/support/real_data.h"
#include "tools/evaluate/text_file.h"
#include "tools/match/baseline_matchers.h"
#include "tools/match/map_faults.h"

namespace maploop::match {
namespace {

using maploop::testing::real_data;

constexpr std::array sequences{"00", "01", "02", "03", "04", "06", "08", "10"};

std::filesystem::path karlsruhe() {
  return real_data() / "maps/karlsruhe_2012-04.osm.pbf";
}

const mapmatch::RuleBases& rules() {
  static const mapmatch::RuleBases bases = mapmatch::read_rule_bases(mapmatch::default_rules());
  return bases;
}

const RecordedDrive& recorded(const std::string& sequence) {
  static std::map<std::string, RecordedDrive> drives;
  const auto known = drives.find(sequence);
  if (known != drives.end()) return known->second;
  return drives[sequence] = read_recorded_drive(real_data() / "kitti_odometry", sequence);
}

struct Compared {
  MatchScore ours, baseline;
};

Compared compare(double interval, const TrackNoise& noise,
                 const mapmatch::MatchParameters& parameters = {}) {
  static const mapmatch::RoadNetwork network(mapmatch::open_network(karlsruhe()));
  Compared compared;
  for (const char* sequence : sequences) {
    const RecordedDrive& drive = recorded(sequence);
    const NoisyTrack noisy = with_noise(drive.track, interval, noise);
    mapmatch::Matcher matcher(network, rules(), parameters);
    compared.ours.add(match_track(matcher, noisy.track), noisy.rows, drive.labels);
    compared.baseline.add(nearest_segments(network, noisy.track), noisy.rows, drive.labels);
  }
  return compared;
}

TrackNoise noisy(double white, double markov) {
  return {white, markov, 30.0, 0.2, radians(3.0), 7};
}

TEST(RealDrives, WithoutNoise) {
  MAPLOOP_REQUIRE_REAL_DATA();
  for (const double interval : {1.0, 0.0}) {
    const Compared c = compare(interval, {});
    // The results are 99.2 and 99.1 %, 100 %, 100 and 99.9 %.
    EXPECT_GE(c.ours.all.share(), 0.988);
    EXPECT_GE(c.ours.certain.share(), 0.9997);
    EXPECT_GE(c.ours.all.coverage(), 0.998);
  }
}

TEST(RealDrives, WhiteNoiseCostsLessThanHalfOfWhatItCostsTheNearestSegment) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Compared five = compare(1.0, noisy(5, 0));
  // The result is 99.8 % with any noise.
  EXPECT_GE(five.ours.certain.share(), 0.995);
  EXPECT_LT(five.ours.all.wrong(), five.baseline.all.wrong());
  for (const double sigma : {10.0, 15.0}) {
    const Compared c = compare(1.0, noisy(sigma, 0));
    EXPECT_GE(c.ours.certain.share(), 0.995) << sigma;
    EXPECT_LE(2 * c.ours.all.wrong(), c.baseline.all.wrong()) << sigma;
    EXPECT_LE(2 * c.ours.certain.wrong(), c.baseline.certain.wrong()) << sigma;
  }
}

TEST(RealDrives, TheRulesAloneMatchAsWellAsTheNearestSegment) {
  MAPLOOP_REQUIRE_REAL_DATA();
  mapmatch::MatchParameters alone;
  alone.paths = false;
  // The results are 98.7, 97.8 and 94.7 % (nearest segment: 99.3, 97.2 and 91.2 %).
  const Compared none = compare(1.0, {}, alone);
  EXPECT_GE(none.ours.all.share(), 0.982);
  EXPECT_GE(none.ours.all.coverage(), 0.999);
  const Compared five = compare(1.0, noisy(5, 0), alone);
  EXPECT_GE(five.ours.all.share(), 0.973);
  EXPECT_LT(five.ours.all.wrong(), five.baseline.all.wrong());
  const Compared fifteen = compare(1.0, noisy(15, 0), alone);
  EXPECT_GE(fifteen.ours.all.share(), 0.935);
  EXPECT_LT(1.3 * static_cast<double>(fifteen.ours.all.wrong()),
            static_cast<double>(fifteen.baseline.all.wrong()));
}

// The hidden Markov model judges each fix by all others, before it and after it.
TEST(RealDrives, AtOnceIsBetterThanTheHiddenMarkovModelAfterwards) {
  MAPLOOP_REQUIRE_REAL_DATA();
  static const mapmatch::RoadNetwork network(mapmatch::open_network(karlsruhe()));
  for (const auto& [white, markov] : {std::pair(5.0, 0.0), std::pair(0.0, 15.0)}) {
    MatchScore model;
    for (const char* sequence : sequences) {
      const RecordedDrive& drive = recorded(sequence);
      const NoisyTrack track = with_noise(drive.track, 1.0, noisy(white, markov));
      model.add(hidden_markov(network, track.track, 5.0), track.rows, drive.labels);
    }
    // The results are 98.5 and 95 %; 98.3 and 88 %.
    const MatchScore ours = compare(1.0, noisy(white, markov)).ours;
    EXPECT_GE(model.all.share(), white > 0.0 ? 0.93 : 0.85);
    EXPECT_LT(1.5 * static_cast<double>(ours.all.wrong()), static_cast<double>(model.all.wrong()));
  }
}

TEST(RealDrives, SlowNoise) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Compared c = compare(1.0, noisy(0, 15));
  EXPECT_GE(c.ours.certain.share(), 0.99);
  EXPECT_LE(2 * c.ours.all.wrong(), c.baseline.all.wrong());
}

TEST(RealDrives, WhatIsSaidWithHighProbabilityIsRight) {
  MAPLOOP_REQUIRE_REAL_DATA();
  Reliability r;
  for (const double sigma : {5.0, 15.0}) r += compare(1.0, noisy(sigma, 0)).ours.reliability;
  ASSERT_GT(r.fixes[9], 1000u);
  EXPECT_NEAR(static_cast<double>(r.right[9]) / static_cast<double>(r.fixes[9]),
              r.p_sum[9] / static_cast<double>(r.fixes[9]), 0.02);
}

// Some parameters of P were chosen on these drives (PARAMETERS.md).
TEST(RealDrives, ProbabilitiesOfLinksAreCalibrated) {
  MAPLOOP_REQUIRE_REAL_DATA();
  static const mapmatch::RoadNetwork network(mapmatch::open_network(karlsruhe()));
  const SegmentLinks links(network);
  MatchScore score;
  for (const char* sequence : {"01", "06", "08", "10"}) {
    RecordedDrive drive = recorded(sequence);
    links.look_up(drive.labels);
    for (const InputCondition& condition : input_conditions()) {
      for (const NoisyTrack& track : condition.realizations(drive, 1)) {
        mapmatch::Matcher matcher(network, rules(), {});
        score.add(match_track(matcher, track.track), track.rows, drive.labels);
      }
    }
  }
  EXPECT_LE(score.reliability.calibration_error(), 0.018);  // the result is 0.014
}

TEST(RealDrives, AWrongMapIsNeverBelievedForLong) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const mapmatch::MapExtract map = mapmatch::read_osm(karlsruhe());
  const mapmatch::NetworkData right = mapmatch::build_network(map);
  const RecordedDrive& drive = recorded("08");
  const auto score = [&](const mapmatch::NetworkData& wrong, std::int64_t missing,
                         double interval = 0.0) {
    const NoisyTrack driven = with_noise(drive.track, interval, {});
    const mapmatch::RoadNetwork network(wrong);
    mapmatch::Matcher matcher(network, rules(), {});
    return score_fault(match_track(matcher, driven.track), driven, drive.labels, missing);
  };
  EXPECT_LE(score(shifted(right, {5.0, 0.0}), 0).longest_sure_wrong, 3.0);
  EXPECT_LE(score(one_way_reversed(right), 0).longest_sure_wrong, 3.0);
  for (const std::int64_t way : {drive.labels.at(1000).way_id, drive.labels.at(3000).way_id}) {
    const FaultScore missing = score(without_way(map, way), way);
    EXPECT_LE(missing.longest_sure_wrong, 3.0) << way;
    EXPECT_LE(missing.recovery, 50.0) << way;
  }
  // The vehicle turns off onto a missing road, with a second between fixes: a path that goes
  // straight on, in line with the vehicle and hundreds of metres behind it, is not a match.
  constexpr std::int64_t turned_into = 4136426;
  EXPECT_LE(score(without_way(map, turned_into), turned_into, 1.0).longest_sure_wrong, 3.0);
}

// Three seconds later nearly every fix away from junctions is on the right way.
TEST(RealDrives, LaterFixesMakeItBetter) {
  MAPLOOP_REQUIRE_REAL_DATA();
  static const mapmatch::RoadNetwork network(mapmatch::open_network(karlsruhe()));
  MatchScore now, lagged;
  for (const char* sequence : {"01", "06", "08", "10"}) {
    const RecordedDrive& drive = recorded(sequence);
    const NoisyTrack noisy_track = with_noise(drive.track, 0.0, noisy(0, 10));
    mapmatch::Matcher matcher(network, rules(), {});
    mapmatch::MatchHistory history(network);
    now.add(match_track(matcher, noisy_track.track, {.history = &history}), noisy_track.rows,
            drive.labels);
    lagged.add(match_later(history, std::chrono::seconds(3), network), noisy_track.rows,
               drive.labels);
  }
  EXPECT_LT(lagged.all.wrong(), now.all.wrong());
  EXPECT_LT(2 * lagged.certain.wrong(), now.certain.wrong() + 2);
  EXPECT_GE(lagged.certain.share(), 0.9985);
}

// Another country and map, positions only; a third of the drive is on roads that the map lacks.
TEST(RealDrives, OffTheMapNoRoadIsSaid) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const auto folder = real_data() / "maps/riverside";
  const mapmatch::RoadNetwork network(
      mapmatch::open_network(folder / "riverside_from_2021_drives.osm.pbf"));
  TrackOptions options;
  options.sigma = 2.0;
  const Track track = read_track(real_data() / "gnss/riverside_drive/groundtruth.csv.gz", options);
  mapmatch::Matcher matcher(network, rules(), {});
  std::vector<MapDoubt> doubts;
  const auto matched = match_track(matcher, track, {.doubts = &doubts});
  const auto in_missing_road = [&](Time t) {
    return std::any_of(doubts.begin(), doubts.end(), [t](const MapDoubt& d) {
      return d.kind == DoubtKind::missing_road && d.probability > 0.5 && d.begin <= t &&
             t <= d.stamp;
    });
  };
  const mapmatch::GeographicBox area = mapmatch::area_of(network);
  // Columns are gps_tow,class,distance_same_heading,distance_any; class "far" has no road near.
  std::set<long> far;
  std::istringstream detail(evaluation::read_text(folder / "off_map_detail_2020.csv.gz"));
  for (std::string line; std::getline(detail, line);)
    if (line.find(",far") != std::string::npos) far.insert(std::atol(line.c_str()));
  std::istringstream labels(evaluation::read_text(folder / "labels_2020.csv.gz"));
  Tally on, off;
  std::size_t sure = 0, inside = 0, doubted_off = 0, doubted_on = 0;
  std::string line;
  std::getline(labels, line);
  for (std::size_t i = 0; i < matched.size() && std::getline(labels, line); ++i) {
    long tow = 0, on_map = 0, way = 0;
    std::sscanf(line.c_str(), "%ld,%ld,%ld", &tow, &on_map, &way);
    ASSERT_NEAR(to_seconds(track[i].stamp.time_since_epoch()), static_cast<double>(tow), 0.01);
    if (on_map == 1) {
      ++on.fixes;
      doubted_on += in_missing_road(track[i].stamp) ? 1 : 0;
      on.right += matched[i].way_id == way ? 1 : 0;
    } else if (far.contains(tow)) {
      ++off.fixes;
      off.matched += matched[i].way_id ? 1 : 0;
      sure += matched[i].way_id && matched[i].p_link > 0.9 ? 1 : 0;
      if (!mapmatch::covers(area, track[i].position, 50.0)) continue;
      ++inside;
      doubted_off += in_missing_road(track[i].stamp) ? 1 : 0;
    }
  }
  ASSERT_GT(on.fixes, 2000u);
  ASSERT_GT(off.fixes, 1000u);
  EXPECT_GE(on.share(), 0.97);
  EXPECT_LE(off.coverage(), 0.01);
  EXPECT_EQ(sure, 0u);
  // The missing roads that the drive shows hold 232 of 232 fixes off the roads within the map's
  // area, and 18 of 2278 on it.
  EXPECT_GE(doubted_off, inside - 10);
  EXPECT_LE(doubted_on, 40u);
}

}  // namespace
}  // namespace maploop::match
