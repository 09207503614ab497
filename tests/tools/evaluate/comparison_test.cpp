// Tests the comparison of several runs with one truth, against errors that are made by hand.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "msgs/frames.h"
#include "tests/support/error_of.h"
#include "tests/support/process.h"
#include "tests/support/real_data.h"
#include "tools/evaluate/rtklib_positions.h"
#include "tools/evaluate/run_errors.h"

namespace maploop::evaluation {
namespace {

using testing::error_of;
using ::testing::HasSubstr;
using ::testing::Not;

// A camera that drives a bend of 200 m at 10 m/s, ten poses a second, in east, north, up.
StampedTrajectory circle() {
  StampedTrajectory t;
  Eigen::Isometry3d R_body_cam = Eigen::Isometry3d::Identity();
  R_body_cam.linear() << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  for (int i = 0; i <= 200; ++i) {
    const double angle = 0.01 * i;  // rad, of a circle of 100 m
    t.stamps.push_back(Time(from_seconds(1e9 + 0.1 * i)));
    t.poses.push_back(
        Eigen::Translation3d(100.0 * std::sin(angle), 100.0 - 100.0 * std::cos(angle), 5.0) *
        Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * R_body_cam);
  }
  return t;
}

StampedTrajectory moved(StampedTrajectory t, const Eigen::Isometry3d& motion, double scale = 1.0) {
  for (Eigen::Isometry3d& pose : t.poses) {
    pose = motion * pose;
    pose.translation() *= scale;
  }
  return t;
}

RunErrors errors(const StampedTrajectory& estimate, Align align,
                 const StampedTrajectory& truth = circle()) {
  Comparison comparison{truth_track("truth", truth), align, {50.0}, {}};
  add_run(comparison, "run", match(estimate, truth, from_seconds(0.01)), estimate.has_attitude);
  return comparison.runs.front();
}

TEST(Comparison, WithoutAlignmentSplitsHorizontalFromVertical) {
  const RunErrors run = errors(
      moved(circle(), Eigen::Isometry3d(Eigen::Translation3d(3.0, 4.0, -12.0))), Align::none);
  EXPECT_NEAR(run.horizontal_m.rmse, 5.0, 1e-9);
  EXPECT_NEAR(run.vertical_m.mean, 12.0, 1e-9);
  EXPECT_NEAR(run.vertical.front(), -12.0, 1e-9);
  EXPECT_NEAR(run.absolute_m.p95, 13.0, 1e-9);
  EXPECT_NEAR(run.end_point_m, 13.0, 1e-9);
  EXPECT_NEAR(run.relative[0].percent, 0.0, 1e-9);
}

TEST(Comparison, EachAlignmentTakesAwayWhatItMay) {
  const Eigen::Isometry3d yawed(Eigen::Translation3d(3.0, 4.0, 5.0) *
                                Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()));
  const Eigen::Isometry3d tilted(yawed * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()));
  const auto rmse = [](const StampedTrajectory& t, Align how) {
    return errors(t, how).absolute_m.rmse;
  };
  for (const Align how : {Align::origin, Align::yaw, Align::se3, Align::sim3})
    EXPECT_LT(rmse(moved(circle(), yawed), how), 1e-6) << to_string(how);
  EXPECT_GT(rmse(moved(circle(), yawed), Align::none), 1.0);
  EXPECT_GT(rmse(moved(circle(), tilted), Align::yaw), 1.0);
  EXPECT_LT(rmse(moved(circle(), tilted), Align::se3), 1e-6);
  const StampedTrajectory small = moved(circle(), yawed, 0.5);
  EXPECT_GT(rmse(small, Align::se3), 1.0);
  EXPECT_LT(rmse(small, Align::sim3), 1e-6);
  EXPECT_NEAR(errors(small, Align::sim3).scale, 2.0, 1e-9);
}

TEST(Comparison, PosesWithoutPartnerAreCountedAndFramesAreTheTruths) {
  StampedTrajectory late = circle();
  late.stamps.erase(late.stamps.begin(), late.stamps.begin() + 20);
  late.poses.erase(late.poses.begin(), late.poses.begin() + 20);
  late.stamps.back() += std::chrono::seconds(9);
  const RunErrors run = errors(late, Align::none);
  EXPECT_EQ(run.matched.unmatched_estimate, 1u);
  EXPECT_EQ(run.matched.unmatched_truth, 21u);
  EXPECT_EQ(run.matched.frames.front(), 20u);
  EXPECT_LT(run.absolute_m.max, 1e-12);
}

TEST(Comparison, BinsAreThoseOfTheTruthsMotion) {
  const RunErrors run = errors(circle(), Align::none);
  ASSERT_EQ(run.by_speed.size(), 1u);
  EXPECT_EQ(run.by_speed[0].low, 30.0) << "36 km/h";
  EXPECT_EQ(run.by_speed[0].poses, 201u);
  ASSERT_EQ(run.by_turn_rate.size(), 1u);
  EXPECT_EQ(run.by_turn_rate[0].low, 5.0) << "0.1 rad/s";
}

TEST(Comparison, PositionsAloneHaveRelativeErrorsButNoRotation) {
  StampedTrajectory places = circle();
  places.has_attitude = false;
  for (Eigen::Isometry3d& pose : places.poses) pose.linear().setIdentity();
  for (std::size_t i = 0; i < places.poses.size(); ++i)
    places.poses[i].translation().z() += 0.001 * static_cast<double>(i);
  const RunErrors run = errors(places, Align::none);
  EXPECT_FALSE(run.has_attitude);
  EXPECT_NEAR(run.relative[0].percent, 0.1, 0.01) << "1 mm a metre";
  EXPECT_NEAR(errors(places, Align::none, places).by_turn_rate[0].low, 5.0, 1e-9)
      << "by its course";
}

Comparison two_runs() {
  Comparison c{truth_track("truth.tum", circle()), Align::none, {50.0}, {}};
  for (const char* name : {"a_b.tum", "c,d|.tum"})
    add_run(c, name, match(circle(), circle(), from_seconds(0.01)), true);
  return c;
}

TEST(Comparison, TablesAreWhatTheirReadersTake) {
  const FigureTable table = figures(two_runs());
  EXPECT_THAT(to_text(table, TableFormat::csv), HasSubstr("figure,unit,a_b.tum,\"c,d|.tum\"\n"));
  EXPECT_THAT(to_text(table, TableFormat::latex), HasSubstr("a\\_b.tum & c,d|.tum \\\\"));
  EXPECT_THAT(to_text(table, TableFormat::latex), HasSubstr("horizontal 95 \\% & m & 0.000"));
  EXPECT_THAT(to_text(table, TableFormat::markdown),
              HasSubstr("| a_b.tum | c,d\\|.tum |\n|---|---|---:|---:|\n"));
}

TEST(Comparison, TheTextHasAtMostEightyColumns) {
  Comparison c = two_runs();
  while (c.runs.size() < 7) c.runs.push_back(c.runs.front());
  std::istringstream text(to_text(c));
  for (std::string line; std::getline(text, line);) EXPECT_LE(line.size(), 80u) << line;
  EXPECT_THAT(text.str(), HasSubstr(" G\n"));
}

nlohmann::json data_of(const std::string& page) {
  const std::string begin = "id=\"comparison-data\">";
  const std::size_t at = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(at, page.find("</script>", at) - at));
}

TEST(Comparison, ThePageIsThinnedButKeepsTheExtremes) {
  StampedTrajectory truth, estimate;
  for (int i = 0; i < 60000; ++i) {  // ten minutes at 100 Hz
    truth.stamps.push_back(Time(from_seconds(0.01 * i)));
    truth.poses.emplace_back(Eigen::Translation3d(0.1 * i, 0.0, 0.0));
  }
  estimate = truth;
  estimate.poses[31234].translation().y() += 7.5;
  estimate.poses[41234].translation().z() -= 2.5;
  Comparison c{truth_track("truth", truth), Align::none, {100.0}, {}};
  for (int i = 0; i < 4; ++i) {
    add_run(c, std::string(1, static_cast<char>('a' + i)),
            match(estimate, truth, from_seconds(0.001)), true);
  }
  const std::string page = to_html(c);
  EXPECT_LT(page.size(), 10'000'000u);
  EXPECT_THAT(page, HasSubstr("are thinned"));
  const nlohmann::json run = data_of(page)["runs"][0];
  EXPECT_LT(run["time"].size(), 11'000u);
  const auto greatest = [&](const char* key) {
    double most = 0.0;
    for (const double v : run[key]) most = std::max(most, std::abs(v));
    return most;
  };
  EXPECT_EQ(greatest("absolute"), 7.5);
  EXPECT_EQ(greatest("vertical"), 7.5) << "the camera's up is the negative y";
  EXPECT_EQ(greatest("horizontal"), 2.5);
  EXPECT_THAT(to_html(two_runs()), Not(HasSubstr("are thinned")));
}

class RtklibPositions : public ::testing::Test {
 protected:
  std::filesystem::path written(const std::string& heading, const std::string& rows) const {
    const auto file = folder_.path() / "a.pos";
    std::ofstream(file) << heading << "  Q  ns\n" << rows;
    return file;
  }

 private:
  testing::TemporaryFolder folder_;
};

TEST_F(RtklibPositions, OfOnePlaceInDegreesAndInXyzAreTheSame) {
  const auto degrees_file = written("%  GPST  latitude(deg) longitude(deg) height(m)",
                                    "2021/09/22 06:30:00.000 35.3381 139.5219 60.0 1 12\n"
                                    "2021/09/22 06:30:01.000 35.3382 139.5219 60.0 6 12\n");
  const StampedTrajectory t = read_trajectory(degrees_file);
  ASSERT_EQ(t.poses.size(), 2u);
  EXPECT_FALSE(t.has_attitude);
  EXPECT_NEAR(t.poses[1].translation().y(), 11.1, 0.1);
  EXPECT_NEAR(degrees(t.origin->latitude), 35.3381, 1e-9);
  const auto positions = read_rtklib_positions(degrees_file);
  EXPECT_EQ(positions[0].quality, 1);
  EXPECT_EQ(positions[1].quality, 6);
  const Eigen::Vector3d p = positions[0].place;
  const auto again = read_rtklib_positions(written(
      "%  GPST  x-ecef(m) y-ecef(m) z-ecef(m)",
      fmt::format("2021/09/22 06:30:00.000 {:.4f} {:.4f} {:.4f} 1 12\n", p.x(), p.y(), p.z())));
  EXPECT_LT((again[0].place - p).norm(), 1e-3);
}

// All other trajectories are in UTC, 18 s behind GPS time in 2021.
TEST_F(RtklibPositions, TheHeadingSaysWhichTimeTheyHave) {
  const std::string row = "2021/09/22 06:30:00.123 35.3381 139.5219 60.0 1 12\n";
  const std::string rest = "  latitude(deg) longitude(deg) height(m)";
  EXPECT_EQ(read_trajectory(written("%  GPST" + rest, row)).stamps[0],
            parse_time("2021-09-22 06:29:42.123"));
  EXPECT_EQ(read_trajectory(written("%  UTC" + rest, row)).stamps[0],
            parse_time("2021-09-22 06:30:00.123"));
  EXPECT_EQ(
      read_trajectory(written("%  GPST" + rest, "2176 282600.123 35.3381 139.5219 60.0 1 12\n"))
          .stamps[0],
      parse_time("2021-09-22 06:29:42.123"));
}

TEST_F(RtklibPositions, AnglesInMinutesAndTimesThatGoBackAreRefused) {
  EXPECT_THAT(error_of([&] {
                read_rtklib_positions(
                    written("%  GPST  latitude(d'\") longitude(d'\") height(m)",
                            "2021/09/22 06:30:00.000 35 20 31.4 139 31 19.1 47.2 1 12\n"));
              }),
              HasSubstr("degrees, minutes and seconds"));
  EXPECT_THAT(error_of([&] {
                read_rtklib_positions(written("%  GPST  latitude(deg) longitude(deg) height(m)",
                                              "2021/09/22 06:30:01.000 35.3 139.5 60.0 1 12\n"
                                              "2021/09/22 06:30:00.000 35.3 139.5 60.0 1 12\n"));
              }),
              HasSubstr("a.pos: the time of position 2 is not after"));
}

TEST_F(RtklibPositions, ARealPairIsComparedAtOnePlace) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const auto folder = testing::real_data() / "gnss/kamakura_kinematic";
  const StampedTrajectory truth = read_trajectory(folder / "rtk_reference.pos.gz", Role::truth);
  const StampedTrajectory estimate =
      in_frame_at(read_trajectory(folder / "rtklib_ppp_kinematic_ge.pos.gz"), truth.origin);
  const RunErrors run = errors(estimate, Align::none, truth);
  EXPECT_GT(run.matched.truth.size(), 300u);
  EXPECT_LT(run.absolute_m.rmse, 10.0) << "metres of a float solution, not of another frame";
  EXPECT_GT(run.by_speed.size(), 1u) << "it stands, then drives";
}

}  // namespace
}  // namespace maploop::evaluation
