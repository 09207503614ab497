// Tests NMEA and CSV files of the fused state.
#include "tools/replay/nav_files.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "msgs/frames.h"

namespace maploop::tools {
namespace {

fusion_score::NavTrack short_track() {
  fusion_score::NavTrack track;
  for (int i = 0; i < 200; ++i) {
    NavState s;
    s.stamp = parse_time("2011-09-30 12:59:59.50") + std::chrono::milliseconds(10 * i);
    s.sequence = static_cast<std::uint64_t>(i);
    s.status = NavStatus::aided;
    s.origin = {radians(49.0), radians(-8.5), 115.0};
    s.velocity_enu = {-3.0, 4.0, 0.0};
    s.attitude.azimuth = radians(-36.87);
    s.forward_speed = 5.0;
    s.covariance.setIdentity();
    s.covariance(0, 0) = 4.0;
    track.add(s);
  }
  return track;
}

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(Nmea, SentencesSayPlaceTimeCourseAndErrors) {
  const auto file = std::filesystem::path(::testing::TempDir()) / "track.nmea";
  write_nmea(file, short_track());
  const auto lines = lines_of(file);
  ASSERT_EQ(lines.size(), 3u * 4u);  // 12:59:59.5, 13:00:00, 13:00:01
  EXPECT_TRUE(
      lines[0].starts_with("$GNGGA,125959.50,4900.0000000,N,00830.0000000,W,6,,,115.000,M,,M,,*"))
      << lines[0];
  EXPECT_TRUE(lines[5].starts_with(
      "$GNRMC,130000.00,A,4900.0000000,N,00830.0000000,W,9.719,323.13,300911,,,E*"))
      << lines[5];
  // The larger axis points east: 90 degrees.
  EXPECT_TRUE(lines[6].starts_with("$GNGST,130000.00,,2.000,1.000,90.0,1.000,2.000,1.000*"))
      << lines[6];
  EXPECT_TRUE(lines[7].starts_with("$GNHDT,323.130,T*")) << lines[7];
}

TEST(Nmea, AHeadingThatIsUnknownIsLeftOut) {
  NavState state = short_track().states().front();
  state.status = NavStatus::without_course;
  fusion_score::NavTrack track;
  track.add(state);
  const auto file = std::filesystem::path(::testing::TempDir()) / "standing.nmea";
  write_nmea(file, track);
  const auto lines = lines_of(file);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_TRUE(lines[2].starts_with("$GNGST")) << lines[2];
}

TEST(NavCsv, HasAColumnForEachHeading) {
  const auto file = std::filesystem::path(::testing::TempDir()) / "track.csv";
  write_nav_csv(file, short_track());
  const auto lines = lines_of(file);
  ASSERT_EQ(lines.size(), 21u);
  const auto commas = [](const std::string& s) { return std::count(s.begin(), s.end(), ','); };
  for (const std::string& line : lines) EXPECT_EQ(commas(line), commas(lines[0])) << line;
  EXPECT_TRUE(lines[1].starts_with("1317387599.500000000,aided,49.000000000,-8.500000000,"))
      << lines[1];
}

TEST(NavFiles, ThatCannotBeWrittenAreNamed) {
  EXPECT_THROW(write_nmea("/nowhere/track.nmea", short_track()), std::runtime_error);
}

}  // namespace
}  // namespace maploop::tools
