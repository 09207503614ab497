// Tests maploop ppp and maploop gnss info as users start them.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "ppp/readers/files/lines.h"
#include "tests/support/process.h"

namespace maploop {
namespace {

using maploop::testing::run;

std::string car(const std::string& name) {
  return (maploop::testing::real_data() / "gnss/kamakura_kinematic" / name).string();
}

std::vector<std::string> ppp_of_the_car() {
  return {maploop::testing::maploop_command(),
          "ppp",
          car("SEPT265G.21O.gz"),
          car("../models/igs14_rebuilt_GE.atx.gz"),
          car("COD0MGXFIN_20212650000_01D_05M_ORB.SP3.gz"),
          car("SEPT2650.21P.gz"),
          car("COD0MGXFIN_20212650000_01D_01D_OSB.BIA.gz"),
          "--systems",
          "GE"};
}

TEST(PppCommand, SmoothesARecordingButNotOnAMap) {
  MAPLOOP_REQUIRE_REAL_DATA();
  auto command = ppp_of_the_car();
  command.insert(command.end(), {"--direction", "smoothed"});
  const auto smoothed = run(command);
  EXPECT_EQ(smoothed.status, 0) << smoothed.error;
  EXPECT_NE(smoothed.out.find("kinematic, smoothed, systems GE"), std::string::npos)
      << smoothed.out;
  const maploop::testing::TemporaryFolder folder;
  const std::string map = folder.path() / "road.osm";
  std::ofstream(map) << "<osm version=\"0.6\"><node id=\"1\" lat=\"35.3\" lon=\"139.5\"/>"
                        "<node id=\"2\" lat=\"35.31\" lon=\"139.5\"/><way id=\"3\"><nd ref=\"1\"/>"
                        "<nd ref=\"2\"/><tag k=\"highway\" v=\"primary\"/></way></osm>";
  command.insert(command.end(), {"--map", map});
  const auto on_map = run(command);
  EXPECT_EQ(on_map.status, 1);
  EXPECT_NE(on_map.error.find("leave out --direction"), std::string::npos) << on_map.error;
}

TEST(PppCommand, WritesEveryFormat) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const maploop::testing::TemporaryFolder folder;
  const auto file = [&](const char* name) { return (folder.path() / name).string(); };
  auto command = ppp_of_the_car();
  for (const std::string& word :
       {std::string("--truth"), car("rtk_reference.pos.gz"), std::string("--pos"), file("a.pos"),
        std::string("--ecef"), std::string("--nmea"), file("a.nmea"), std::string("--geojson"),
        file("a.geojson"), std::string("--kml"), file("a.kml"), std::string("--csv"), file("a.csv"),
        std::string("--html"), file("a.html"), std::string("--json"), file("a.json")}) {
    command.push_back(word);
  }
  const auto result = run(command);
  ASSERT_EQ(result.status, 0) << result.error;
  EXPECT_NE(result.out.find("360 of 360 epochs have a position"), std::string::npos) << result.out;
  const auto figures = nlohmann::json::parse(ppp::read_file(file("a.json")));
  EXPECT_EQ(figures["truth"]["coverage"], 1.0);
  EXPECT_EQ(nlohmann::json::parse(
                ppp::read_file(file("a.geojson")))["features"][0]["geometry"]["coordinates"]
                .size(),
            360U);
  const std::string pos = ppp::read_file(file("a.pos"));
  EXPECT_NE(pos.find("\n2021/09/22 06:30:00.000  -39619"), std::string::npos);
  const std::string nmea = ppp::read_file(file("a.nmea"));
  EXPECT_EQ(nmea.find("$GNGGA,062942.000,3520.52"), 0U) << nmea.substr(0, 80);
  EXPECT_NE(ppp::read_file(file("a.html")).find("Sky"), std::string::npos);
  EXPECT_NE(ppp::read_file(file("a.csv")).find("below the elevation mask"), std::string::npos);
  EXPECT_NE(ppp::read_file(file("a.kml")).find("</kml>"), std::string::npos);
}

TEST(PppCommand, StartAndEndCutTheEpochs) {
  MAPLOOP_REQUIRE_REAL_DATA();
  auto command = ppp_of_the_car();
  for (const char* word : {"--start", "06:31:00", "--end", "2021-09-22 06:31:59"}) {
    command.push_back(word);
  }
  const auto result = run(command);
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_NE(result.out.find("60 of 60 epochs"), std::string::npos) << result.out;
}

TEST(PppCommand, TakesSecondsForTimesAndLeavesOutTheEpochsOfAnOutage) {
  MAPLOOP_REQUIRE_REAL_DATA();
  auto command = ppp_of_the_car();
  command.insert(command.end(), {"--start", "60", "--end", "119", "--gnss-outage", "80:10"});
  const auto result = run(command);
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_NE(result.out.find("50 of 50 epochs"), std::string::npos) << result.out;
}

TEST(PppCommand, AccuracyCanBeThatBehindTheConvergence) {
  MAPLOOP_REQUIRE_REAL_DATA();
  auto command = ppp_of_the_car();
  command.insert(command.end(), {"--score-start", "06:32:00"});
  EXPECT_EQ(run(command).status, 2) << "of what, without a truth";
  command.insert(command.end(), {"--truth", car("rtk_reference.pos.gz")});
  const auto result = run(command);
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_NE(result.out.find("360 of 360 epochs have a position"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("truth: 238 of 238 epochs"), std::string::npos) << result.out;
}

TEST(PppCommand, TheTruthMayBeGeodeticAndMustBeOnTheEarth) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const auto scored = [](const char* truth) {
    auto command = ppp_of_the_car();
    command.insert(command.end(), {"--truth", truth});
    return run(command);
  };
  // The base station is given in both forms.
  const auto ecef = scored("-3959400.631,3385704.533,3667523.111");
  const auto geodetic = scored("35.3266819,139.4660717,46.501");
  const auto figure = [](const std::string& text) {
    const std::size_t at = text.find("horizontal RMSE ");
    return at == std::string::npos ? -1.0 : std::stod(text.substr(at + 16));
  };
  EXPECT_GT(figure(ecef.out), 0.0) << ecef.out << ecef.error;
  EXPECT_NEAR(figure(geodetic.out), figure(ecef.out), 0.05) << geodetic.out << geodetic.error;
  for (const char* nowhere : {"1000,2000,3000", "91,0,5", "1e9,0,0"}) {
    const auto refused = scored(nowhere);
    EXPECT_EQ(refused.status, 1) << nowhere;
    EXPECT_NE(refused.error.find("is no place near the earth's surface"), std::string::npos)
        << refused.error;
  }
}

TEST(PppCommand, ReportsWhereItCannotConverge) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const auto folder = maploop::testing::real_data() / "gnss/riverside_drive";
  const auto result =
      run({maploop::testing::maploop_command(), "ppp", (folder / "COM3_200712.obs.gz").string(),
           (folder / "COM3_200712.nav.gz").string(), "--end", "01:37:00"});
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_NE(result.out.find("on one frequency with broadcast orbits"), std::string::npos)
      << result.out;
}

TEST(PppCommand, ErrorsNameWhatIsWrong) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const auto no_orbits = run({maploop::testing::maploop_command(), "ppp", car("SEPT265G.21O.gz")});
  EXPECT_EQ(no_orbits.status, 1);
  EXPECT_NE(no_orbits.error.find("no orbits: add an SP3 file"), std::string::npos);
  auto bad_time = ppp_of_the_car();
  bad_time.insert(bad_time.end(), {"--start", "noon"});
  EXPECT_NE(run(bad_time).error.find("--start: 'noon'"), std::string::npos);
}

TEST(GnssInfoCommand, TellsFilesApartAndNamesBadOnes) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const auto result =
      run({maploop::testing::maploop_command(), "gnss", "info", car("SEPT265G.21O.gz"),
           car("rtk_reference.pos.gz"), car("SEPT2650.21P.gz")});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.out.find("epochs        360, every 1.000 s, 0 gaps"), std::string::npos);
  EXPECT_NE(result.out.find("broadcast navigation"), std::string::npos);
  EXPECT_NE(result.error.find("rtk_reference.pos.gz: not in a known format"), std::string::npos);
  EXPECT_NE(result.out.find("reach         two frequencies, broadcast orbits"), std::string::npos);
}

TEST(GnssInfoCommand, SaysWhatTheFilesReachTogether) {
  MAPLOOP_REQUIRE_REAL_DATA();
  std::vector<std::string> command = ppp_of_the_car();
  command.resize(command.size() - 2);
  command[1] = "gnss";
  command.insert(command.begin() + 2, "info");
  const auto with_biases = run(command);
  EXPECT_EQ(with_biases.status, 0) << with_biases.error;
  EXPECT_NE(with_biases.out.find("reach         two frequencies, integers"), std::string::npos)
      << with_biases.out;
  command.pop_back();
  const auto without = run(command);
  EXPECT_NE(without.out.find("reach         two frequencies, real-valued"), std::string::npos);
  EXPECT_NE(without.out.find("lack          no biases of phases"), std::string::npos);
}

}  // namespace
}  // namespace maploop
