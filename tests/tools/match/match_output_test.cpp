#include "tools/match/match_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/mapmatch/simulated_drive.h"
#include "tests/mapmatch/small_map.h"
#include "tests/support/real_data.h"
#include "tools/match/decision_data.h"
#include "tools/match/match_score.h"
#include "tools/match/match_summary.h"

namespace maploop::match {
namespace {

using maploop::testing::SmallMap;
using ::testing::HasSubstr;

std::string read(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class MatchOutput : public ::testing::Test {
 public:
  MatchOutput() {
    mapmatch::Matcher matcher(network, rules, {});
    track.fixes = maploop::testing::drive({{-90, 0}, {90, 0}}, 10.0, 1.0);
    track.fixes.push_back(track.fixes.back());  // not later, so that it is not used
    track.fixes.push_back(track.fixes.back());
    track.fixes.back().stamp += std::chrono::hours(1);
    track.fixes.back().position = SmallMap::place(4000, 4000);
    for (const auto& fix : track.fixes) track.results.push_back(matcher.add(fix));
  }

  mapmatch::Road named() {
    mapmatch::Road road;
    road.name = "</script>\xff";
    return road;
  }
  mapmatch::RoadNetwork network = SmallMap()
                                      .node(1, -100, 0)
                                      .node(2, 0, 0)
                                      .node(3, 100, 0)
                                      .way(10, {1, 2, 3}, named())
                                      .network();
  mapmatch::RuleBases rules = mapmatch::read_rule_bases(mapmatch::default_rules());
  MatchedTrack track;
  maploop::testing::TemporaryFolder folder;
};

TEST_F(MatchOutput, CsvHasOneRowAFixAndEmptyIdsWhereThereIsNoRoad) {
  write_match_csv(folder.path() / "a.csv", track, network);
  std::istringstream lines(read(folder.path() / "a.csv"));
  std::vector<std::string> rows;
  for (std::string line; std::getline(lines, line);) rows.push_back(line);
  ASSERT_EQ(rows.size(), track.fixes.size() + 1);
  EXPECT_EQ(rows[0],
            "t,lat,lon,phase,way_id,node_a,node_b,matched_lat,matched_lon,azimuth_deg,likelihood,"
            "p_link,lanes,lane,p_lane");
  for (const std::string& row : rows) EXPECT_EQ(std::count(row.begin(), row.end(), ','), 14) << row;
  EXPECT_THAT(rows[5], HasSubstr(",along link,10,1,2,"));
  EXPECT_THAT(rows[15], HasSubstr(",along link,10,2,3,"));
  EXPECT_THAT(rows[rows.size() - 2], HasSubstr(",not used,,,,,,,,"));
  EXPECT_THAT(rows.back(), ::testing::EndsWith(",,,,,,,,,,"));
  EXPECT_THAT(rows[5], ::testing::EndsWith(",,,")) << "the map tells no lanes";
}

TEST_F(MatchOutput, GeoJsonAndGpxHoldTheMatchedPositions) {
  write_match_gpx(folder.path() / "a.gpx", track, network);
  const std::string gpx = read(folder.path() / "a.gpx");
  std::size_t points = 0;
  for (std::size_t at = 0; (at = gpx.find("<trkpt", at)) != std::string::npos; ++at) ++points;
  EXPECT_EQ(points, track.fixes.size() - 2);
  // The name is not valid UTF-8; GeoJSON is UTF-8 and contains a replacement character.
  write_match_geojson(folder.path() / "a.geojson", track, network);
  const auto json = nlohmann::json::parse(read(folder.path() / "a.geojson"));
  EXPECT_EQ(json["features"].size(), track.fixes.size() + 1);
  EXPECT_EQ(json["features"][5]["properties"]["way_id"], 10);
  EXPECT_EQ(json["features"].back()["geometry"]["coordinates"].size(), track.fixes.size() - 2);
}

TEST_F(MatchOutput, ThePageNeedsNothingElseAndNoNameEndsItsScript) {
  write_match_html(folder.path() / "a.html", track, network, rules);
  const std::string page = read(folder.path() / "a.html");
  for (const char* fetched : {"<script src", "<img", "<link", "@import", "url(http"})
    EXPECT_EQ(page.find(fetched), std::string::npos) << fetched;
  for (std::size_t at = 0; (at = page.find("</script>", at)) != std::string::npos; ++at)
    EXPECT_NE(page[at - 1], '"') << "a name ended a script";
  EXPECT_THAT(page, HasSubstr("way 10"));
}

TEST_F(MatchOutput, ThePageHasTheReasonsOfEachFixThatWasUsedAndEachSentenceOnce) {
  const auto data = decision_data(track, network, rules);
  const std::size_t used = track.fixes.size() - 1;
  for (const char* list :
       {"time", "x", "y", "matched_x", "p", "phase", "explanation", "candidates"})
    EXPECT_EQ(data[list].size(), used) << list;
  const auto texts = data["texts"].get<std::vector<std::string>>();
  EXPECT_EQ(std::set<std::string>(texts.begin(), texts.end()).size(), texts.size());
  EXPECT_THAT(texts[data["explanation"][5].get<std::size_t>()], HasSubstr("(way 10), P "));
  EXPECT_EQ(texts[data["explanation"].back().get<std::size_t>()], "no road near");
  EXPECT_TRUE(data["matched_x"].back().is_null());
  const auto& candidate = data["candidates"][5][0];
  EXPECT_THAT(texts[candidate[7][0].get<std::size_t>()], HasSubstr(": if "));
  EXPECT_THAT(data["roads"][candidate[0].get<std::size_t>()]["name"].get<std::string>(),
              HasSubstr("way 10, "));
}

TEST_F(MatchOutput, TheSummaryCountsEachFixOnce) {
  const MatchSummary s = summary(track, network);
  EXPECT_EQ(s.fixes, track.fixes.size());
  EXPECT_EQ(s.matched, track.fixes.size() - 2);
  EXPECT_EQ(s.off_road, 0U) << "a place outside of the map is not off road";
  EXPECT_THAT(s.unused, ::testing::ElementsAre(::testing::Pair("not later than the fix before", 1U),
                                               ::testing::Pair("outside of the map", 1U)));
  EXPECT_LE(s.doubtful, s.matched);
}

TEST_F(MatchOutput, AFolderThatIsNotThereIsNamed) {
  EXPECT_THROW(write_match_csv(folder.path() / "none/a.csv", track, network), std::runtime_error);
}

}  // namespace
}  // namespace maploop::match
