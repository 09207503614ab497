// Tests the sections of the replay's page for synthetic runs.
#include "tools/report/report.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "msgs/frames.h"
#include "tests/support/real_data.h"

namespace maploop::report {
namespace {

constexpr Geodetic origin{0.855, 0.147, 110.0};
const Eigen::Vector3d antenna(1.0, -0.5, 1.6);

Time at(double seconds) {
  return from_nanoseconds(1'317'042'651'000'000'000) + from_seconds(seconds);
}

// Returns positions due east at 10 m/s.
Eigen::Vector3d place(double seconds) {
  return {10.0 * seconds, 0.0, 0.0};
}

std::vector<ReferencePose> straight_drive(double seconds) {
  std::vector<ReferencePose> rows;
  for (double t = 0.0; t < seconds; t += 0.1) {
    ReferencePose row;
    row.stamp = row.available = at(t);
    row.position = LocalFrame(origin).to_geodetic(place(t));
    row.attitude.azimuth = radians(90.0);
    rows.push_back(row);
  }
  return rows;
}

// Returns positions that are 0.3 m too far north and 0.4 m too high, with sigmas of 0.2 m.
std::map<Time, PppState> ppp_of(double seconds) {
  std::map<Time, PppState> states;
  for (int t = 0; t < static_cast<int>(seconds); ++t) {
    PppState s;
    s.stamp = at(t);
    s.status = t == 0 ? PppStatus::none : t < 3 ? PppStatus::converging : PppStatus::converged;
    // East is forward, north is left.
    const Eigen::Vector3d error(0.0, 0.3, 0.4);
    s.position = LocalFrame(origin).to_geodetic(place(t) + antenna + error);
    s.position_covariance = 0.04 * Eigen::Matrix3d::Identity();
    s.satellites_used = 7;
    s.satellites.resize(9);
    s.satellites[8].refusal = PppRefusal::weak;
    states[s.stamp] = s;
  }
  return states;
}

using Matches = std::map<Time, tools::RoadMoment>;
using Reference = std::vector<ReferencePose>;

std::string page_of(const tools::ReplayResult& result, const tools::RunPass& pass,
                    const Reference& reference) {
  vehicle::VehicleConfig config;
  config.fusion.gnss_lever_forward = antenna.x();
  config.fusion.gnss_lever_left = antenna.y();
  config.fusion.gnss_lever_up = antenna.z();
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "report.html";
  write_report(file, {result, pass, reference, config});
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::string page_of(const tools::ReplayResult& result, Matches matches,
                    std::map<Time, PppState> ppp, const Reference& reference) {
  tools::RunPass pass;
  pass.matches = std::move(matches);
  pass.ppp_states = std::move(ppp);
  return page_of(result, pass, reference);
}

bool has(const std::string& page, const std::string& part) {
  return page.find(part) != std::string::npos;
}

TEST(Report, PppIsScoredAtTheAntenna) {
  const std::string page = page_of({}, {}, ppp_of(10.0), straight_drive(10.0));
  EXPECT_TRUE(has(page, "10 epochs, 90.0 % with a position: 7 converged, 2 converging"));
  EXPECT_TRUE(has(page, "7.0 satellites used on average"));
  EXPECT_TRUE(has(page,
                  "<td>all epochs</td><td>9</td><td>0.300</td><td>0.300</td><td>0.400</td>"
                  "<td>100.0</td><td>6.25</td>"))
      << page.substr(page.find("Precise"), 1500);
  EXPECT_TRUE(has(page, "<td>converged</td><td>7</td>"));
  EXPECT_TRUE(has(page, "<td>signal too weak</td><td>10</td>"));
  EXPECT_TRUE(has(page, "Error up, PPP"));
  EXPECT_FALSE(has(page, "Link identification"));
}

TEST(Report, ErrorsAreComparedWithTheirProtectionLevels) {
  tools::ReplayResult result;
  auto& protection = result.protection.emplace();
  protection.risk = 1e-4;
  for (int i = 0; i < 10; ++i)
    protection.moments.push_back({at(0.1 * i), i >= 8, {1.0, 2.0}, {0.5, 1.5}, {1.25, 2.25}});
  protection.doubted = 2;
  protection.along = {3, 2.0};
  const std::string page = page_of(result, {}, {}, straight_drive(2.0));
  EXPECT_TRUE(has(page, "There are 10 moments with a reference; in 2 of them an aid was doubted"));
  EXPECT_TRUE(has(page, "<td>along the way</td><td>3</td><td>2.00</td>"));
  EXPECT_TRUE(has(page, "Stanford plot of the fused position"));
  EXPECT_TRUE(has(page, "horizontal, with an aid doubted"));
  // The level of a moment in which it does not hold is a gap.
  EXPECT_TRUE(has(page, "2.25,null")) << page.substr(page.find("its protection level"), 600);
  EXPECT_FALSE(has(page_of({}, {}, {}, straight_drive(2.0)), "Protection levels"));
}

TEST(Report, PppWithoutATruthOrAnyPositionSaysSo) {
  EXPECT_TRUE(has(page_of({}, {}, ppp_of(10.0), {}), "There is no truth at its epochs"));
  EXPECT_TRUE(has(page_of({}, {}, ppp_of(1.0), {}), "1 epochs, 0.0 % with a position"));
}

TEST(Report, LinksAreCountedWhereTheDrivenOnesAreKnown) {
  Matches matches;
  for (int i = 0; i < 20; ++i) {
    const MatchPhase phase = i < 5 ? MatchPhase::initial : MatchPhase::along_link;
    matches[at(0.1 * i)] = {{at(0.1 * i), {}}, phase, i >= 5, origin};
  }
  const std::string unknown = page_of({}, matches, {}, straight_drive(2.0));
  EXPECT_TRUE(has(unknown, "does not say which links were driven"));
  EXPECT_TRUE(has(unknown, "<td>along link</td><td>15</td><td>75.0</td>"));
  EXPECT_FALSE(has(unknown, "Precise point positioning"));

  tools::ReplayResult result;
  result.links.emplace();
  result.links->all = {20, 15, 12};
  result.links->reliability.fixes[9] = 15;
  result.links->reliability.right[9] = 12;
  result.links->reliability.p_sum[9] = 13.8;
  const std::string known = page_of(result, matches, {}, straight_drive(2.0));
  EXPECT_TRUE(has(known, "<td>all labels</td><td>20</td><td>60.00</td><td>75.00</td><td>8</td>"));
  EXPECT_TRUE(has(known, "Reliability of P(link)"));
}

TEST(Report, WhatWasOutOfTheOrdinaryIsOnTheTimeline) {
  Matches matches;
  for (int i = 0; i < 20; ++i) {
    matches[at(0.5 * i)] = {{at(0.5 * i), {}},
                            i > 3 && i < 10 ? MatchPhase::off_road : MatchPhase::along_link,
                            true,
                            origin};
  }
  tools::ReplayResult result;
  result.begin = at(0.0);
  result.faults = {{"lost@gnss:3:2", 2}};
  result.outage_ends = {{6.0, 1.5, 15.0, 0.7, 1.0, {}}};
  const std::string page = page_of(result, matches, ppp_of(10.0), straight_drive(10.0));
  EXPECT_TRUE(has(page, R"("from":3.0,"level":"error","section":"What-was-lost-or-not-used",)"
                        R"("text":"fault lost@gnss:3:2: 2 struck","to":5.0)"));
  EXPECT_TRUE(has(page, R"("from":6.0,"level":"warning","section":"Absolute-error",)"
                        R"("text":"no GNSS; the error grew to 0.7 m","to":7.5)"));
  EXPECT_TRUE(has(page, R"("from":2.0,"level":"note","section":"Link-identification",)"
                        R"("text":"off the roads of the map","to":4.5)"));
  EXPECT_TRUE(has(page, R"("text":"no position by PPP: ","to":0.0)"));
}

TEST(Report, TheLargestErrorIsAnEvent) {
  tools::RunPass pass;
  for (int second = 0; second < 5; ++second) {
    NavState s;
    s.stamp = at(second);
    s.status = NavStatus::aided;
    s.origin = origin;
    s.position_enu = place(second) + Eigen::Vector3d(0.0, second == 3 ? -2.0 : 1.0, 9.0);
    s.covariance(0, 0) = 0.75;
    s.covariance(1, 1) = 0.25;
    pass.track.add(s);
  }
  const std::string page = page_of(tools::ReplayResult{}, pass, straight_drive(10.0));
  EXPECT_TRUE(has(page, R"("from":3.0,"level":"note","section":"Absolute-error",)"
                        R"("text":"the largest horizontal error, 2.00 m; 3 sigma 3.00 m")"));
}

TEST(Report, ARunWithoutAnythingHasAPageToo) {
  EXPECT_TRUE(has(page_of({}, {}, {}, {}), "Way of the vehicle"));
}

TEST(Report, CalibrationShowsTheBestObservedPropertyFirst) {
  tools::RunPass pass;
  for (int second = 0; second < 3; ++second) {
    vehicle::CalibrationReport moment;
    moment.stamp = at(second);
    moment.properties[0] = {"axle", "rear axle behind the origin", "m", 0.8, 0.95, 1.0};
    moment.properties[1] = {"scale", "scale of wheels", "%", 1.0, 0.4 - 0.1 * second, 1.0};
    pass.calibrations.push_back(moment);
  }
  const std::string page = page_of(tools::ReplayResult{}, pass, {});
  EXPECT_TRUE(has(page, "Calibration on the drive"));
  EXPECT_TRUE(has(page, "The car as it was described"));
  const auto best = page.find("<td>scale of wheels</td><td>1.000</td><td>0.200</td>"),
             other = page.find("<td>rear axle behind the origin</td>");
  ASSERT_NE(best, std::string::npos);
  EXPECT_LT(best, other);
  EXPECT_TRUE(has(page.substr(other), "<td>95</td><td>not yet</td>"));
  EXPECT_TRUE(has(page, "\"title\":\"scale of wheels\""));
  EXPECT_FALSE(has(page, "\"title\":\"rear axle behind the origin\""))
      << "the drive has hardly shown it";
}

TEST(Report, FilterThatHasNotStartedHasNoCalibration) {
  tools::RunPass pass;
  pass.calibrations.emplace_back();
  EXPECT_FALSE(has(page_of(tools::ReplayResult{}, pass, {}), "Calibration on the drive"));
}

}  // namespace
}  // namespace maploop::report
