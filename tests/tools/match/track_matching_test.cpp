// Tests the matching of many tracks in one call.
#include "tools/match/track_matching.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/mapmatch/simulated_drive.h"
#include "tests/mapmatch/small_map.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"
#include "tools/evaluate/text_file.h"

namespace maploop::match {
namespace {

using maploop::testing::drive;
using maploop::testing::SmallMap;
using ::testing::HasSubstr;

class TrackMatchingTest : public ::testing::Test {
 protected:
  // Returns tracks of different lengths by the names of their files; that named "far" is elsewhere.
  static Track read(const std::filesystem::path& file) {
    const std::string name = file.filename().string().substr(0, file.filename().string().find('.'));
    if (name == "far") return drive({{9000, 9000}, {9100, 9000}}, 10.0, 1.0);
    if (name == "broken") throw std::runtime_error("broken.csv: line 3: no latitude");
    return drive({{10, 0}, {100.0 * static_cast<double>(name.size()), 0}}, 10.0, 1.0);
  }

  std::string text(const std::string& file) const {
    return evaluation::read_text(folder_.path() / file);
  }

  // Returns the error, if there is one.
  std::string match(const std::vector<std::filesystem::path>& files) {
    const std::vector<TrackOutput> outputs{
        {folder_.path(), ".csv", [this](const auto& file, const MatchedTrack& track) {
           write_match_csv(file, track, network_);
         }}};
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    std::string error;
    try {
      match_tracks(files, read, matching_, outputs);
    } catch (const std::exception& e) {
      error = e.what();
    }
    printed_ = ::testing::internal::GetCapturedStdout();
    warned_ = ::testing::internal::GetCapturedStderr();
    return error;
  }

  mapmatch::RoadNetwork network_ =
      SmallMap().node(1, 0, 0).node(2, 500, 0).node(3, 1000, 0).way(10, {1, 2, 3}).network();
  mapmatch::RuleBases rules_ = mapmatch::read_rule_bases(mapmatch::default_rules());
  mapmatch::MatchParameters parameters_;
  TrackMatching matching_{network_, rules_, parameters_};
  maploop::testing::TemporaryFolder folder_;
  std::string printed_, warned_;
};

TEST_F(TrackMatchingTest, GivesEachTrackTheFileThatItHasAlone) {
  EXPECT_EQ(match({"ab.csv", "here/abc.csv.gz", "abcd.gpx", "abcde.csv", "abcdef.csv"}), "");
  for (const char* name : {"ab", "abc", "abcd", "abcde", "abcdef"}) {
    const MatchedTrack alone = matching_.match(read(name), name, nullptr);
    write_match_csv(folder_.path() / "alone", alone, network_);
    EXPECT_EQ(text(std::string(name) + ".csv"), text("alone")) << name;
  }
  EXPECT_THAT(printed_, HasSubstr("all 5 tracks"));
  EXPECT_LT(printed_.find("abc.csv"), printed_.find("abcd.gpx")) << "in the order of the call";
}

TEST_F(TrackMatchingTest, NamesTheTracksThatFailAndMatchesTheOthers) {
  EXPECT_THAT(match({"ab.csv", "broken.csv", "far.csv", "abc.csv"}),
              HasSubstr("2 of 4 tracks could not be matched"));
  EXPECT_THAT(warned_, HasSubstr("broken.csv: line 3: no latitude"));
  EXPECT_THAT(warned_, HasSubstr("far.csv: "));
  EXPECT_THAT(printed_, HasSubstr("all 2 tracks"));
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "abc.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "far.csv"));
}

TEST_F(TrackMatchingTest, RefusesTracksWhoseResultsWouldOverwriteEachOther) {
  EXPECT_THAT(match({"a/drive.gpx", "b/drive.gpx"}), HasSubstr("match them apart"));
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(TrackMatchingTest, LaterFixesJudgeTheEarlierOnes) {
  TrackMatching later{network_, rules_, parameters_, std::chrono::seconds(3)};
  const Track fixes = read("abcd");
  const MatchedTrack track = later.match(fixes, "abcd", nullptr);
  ASSERT_EQ(track.results.size(), fixes.size());
  EXPECT_TRUE(track.results.front().on_road) << "at once, initial matching would not be over";
}

}  // namespace
}  // namespace maploop::match
