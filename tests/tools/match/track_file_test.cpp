#include "tools/match/track_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "msgs/frames.h"
#include "tests/support/real_data.h"
#include "tests/tools/refusal.h"

namespace maploop::match {
namespace {

using maploop::testing::refusal;
using ::testing::HasSubstr;

std::string csv_refusal(const std::string& text) {
  return refusal([&] { parse_csv_track(text, "a.csv", {}); });
}

TEST(CsvTrack, ColumnsAreFoundByTheirNamesInAnyOrder) {
  const Track track = parse_csv_track(
      "Longitude;Latitude;other;t;speed;azimuth_deg;sigma_e;sigma_n\r\n"
      "8.5;49.25;x;10.5;12;270;3;4\r\n8.6;49.35;y;11.5;;;;\r\n",
      "a.csv", {});
  ASSERT_EQ(track.size(), 2u);
  EXPECT_NEAR(degrees(track[0].position.latitude), 49.25, 1e-12);
  EXPECT_EQ(track[0].stamp, Time(from_seconds(10.5)));
  EXPECT_EQ(track[0].speed, 12.0);
  EXPECT_NEAR(degrees(track[0].azimuth), 270.0, 1e-9);
  EXPECT_EQ(track[0].covariance(0, 0), 9.0);
  EXPECT_EQ(track[0].covariance(1, 1), 16.0);
  EXPECT_TRUE(std::isnan(track[1].speed));
  EXPECT_TRUE(std::isnan(track[1].azimuth));
  EXPECT_EQ(track[1].covariance(0, 0), 25.0) << "5 m where nothing is said";
}

TEST(CsvTrack, CovariancesAndDates) {
  const Track track = parse_csv_track(
      "timestamp,lat,lon,cov_ee,cov_en,cov_nn\n2011-09-26T13:10:51.5Z,49,8,4,1,9\n", "a.csv", {});
  EXPECT_EQ(track[0].covariance(0, 1), 1.0);
  EXPECT_EQ(track[0].stamp, parse_time("2011-09-26 13:10:51.5"));
}

TEST(CsvTrack, MistakesAreNamedWithTheirLine) {
  EXPECT_THAT(csv_refusal(""), HasSubstr("empty"));
  EXPECT_THAT(csv_refusal("x,y\n1,2\n"), HasSubstr("a.csv:1: no columns t, lat and lon"));
  EXPECT_THAT(csv_refusal("t,lat,lon\n1,49,8\n2,abc,8\n"), HasSubstr("a.csv:3: 'abc'"));
  EXPECT_THAT(csv_refusal("t,lat,lon\n1,49\n"), HasSubstr("a.csv:2: a column is missing"));
  EXPECT_THAT(csv_refusal("t,lat,lon\nnoon,49,8\n"), HasSubstr("a.csv:2: 'noon' is not a time"));
}

TEST(CsvTrack, ALineOfColumnsWithoutEndIsRefused) {
  EXPECT_THAT(csv_refusal("t,lat,lon\n1,49,8" + std::string(1'000'000, ',')),
              HasSubstr("a.csv:2: more than 1024 columns"));
  EXPECT_THAT(csv_refusal("t,lat,lon" + std::string(1'000'000, ',')),
              HasSubstr("a.csv:1: more than 1024 columns"));
}

TEST(CsvTrack, MoreFixesThanATrackHasAreRefused) {
  std::string text = "t,lat,lon\n";
  for (int i = 0; i < 300'000; ++i) text += std::to_string(i) + ",49,8\n";
  EXPECT_THAT(csv_refusal(text), HasSubstr("a.csv: more than 262144 fixes"));
}

TEST(TumTrack, AStampThatIsNoTimeIsRefusedWithItsLine) {
  TrackOptions options;
  options.origin = Geodetic{0.8, 0.1, 0.0};
  EXPECT_THAT(refusal([&] { parse_tum_track("1e300 0 0 0 0 0 0 1\n", "a.tum", options); }),
              HasSubstr("a.tum:1: "));
}

TEST(CsvTrack, OxtsOfARecordedDriveIsATrack) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Track track =
      read_track(maploop::testing::real_data() / "kitti_odometry/oxts/04.csv.gz", {});
  ASSERT_EQ(track.size(), 271u);
  EXPECT_NEAR(track[100].speed, 14.0, 3.0);
  EXPECT_TRUE(std::isfinite(track[100].azimuth));
  EXPECT_LT(track[100].covariance(0, 0), 1.0);
}

TEST(GpxTrack, TrackPointsWithTheirExtensions) {
  const std::string gpx =
      "<?xml version=\"1.0\"?><gpx><trk><trkseg>"
      "<trkpt lat=\"49.1\" lon='8.2'><ele>1</ele><time>2020-01-02T03:04:05Z</time>"
      "<extensions><gpxtpx:speed>7.5</gpxtpx:speed><gpxtpx:course>90</gpxtpx:course></extensions>"
      "</trkpt><trkpt lon=\"8.3\" lat=\"49.2\"><time>2020-01-02T03:04:06.5Z</time></trkpt>"
      "</trkseg></trk></gpx>";
  const Track track = parse_gpx_track(gpx, "a.gpx", {});
  ASSERT_EQ(track.size(), 2u);
  EXPECT_EQ(track[0].speed, 7.5);
  EXPECT_NEAR(track[0].azimuth, radians(90.0), 1e-12);
  EXPECT_TRUE(std::isnan(track[1].speed));
  EXPECT_EQ(track[1].stamp - track[0].stamp, std::chrono::milliseconds(1500));
  EXPECT_THAT(refusal([&] { parse_gpx_track("<trkpt lat=\"1\" lon=\"2\"/>", "a.gpx", {}); }),
              HasSubstr("track point 1: no time"));
}

std::string gpx_of(const std::string& points) {
  return "<gpx><trk><trkseg>" + points + "</trkseg></trk></gpx>";
}

std::string gpx_point(const std::string& second) {
  return "<trkpt lat=\"49.1\" lon=\"8.2\"><time>2020-01-02T03:04:" + second + "Z</time></trkpt>";
}

TEST(GpxTrack, IsReadAsXml) {
  const std::string content =
      "<!-- <trkpt lat=\"1\" lon=\"2\"/> --><g:trkpt\tlat='49.1'\nlon='8.2'><g:time> "
      "2020-01-02T03:04:05Z </g:time></g:trkpt>";
  EXPECT_EQ(parse_gpx_track(gpx_of(content), "a.gpx", {}).size(), 1u);
}

TEST(GpxTrack, AFileThatWasCutIsRefused) {
  const std::string gpx = gpx_of(gpx_point("05") + gpx_point("06"));
  for (std::size_t size = 1; size < gpx.size(); ++size) {
    EXPECT_THAT(refusal([&] { parse_gpx_track(gpx.substr(0, size), "a.gpx", {}); }),
                HasSubstr("was it cut"));
  }
  EXPECT_THAT(refusal([&] {
                parse_gpx_track(gpx_of("<trkpt lat='1' lon='2'>" + gpx_point("06")), "a.gpx", {});
              }),
              HasSubstr("track point 2: the point before it does not end"));
}

TEST(GpxTrack, SegmentsAreInTheOrderOfTheirTime) {
  const std::string gpx = gpx_of(gpx_point("25") + gpx_point("26") + "</trkseg><trkseg>" +
                                 gpx_point("05") + gpx_point("06") + "</trkseg><trkseg>");
  const Track track = parse_gpx_track(gpx, "a.gpx", {});
  ASSERT_EQ(track.size(), 4u);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_LT(track[i - 1].stamp, track[i].stamp);
}

TEST(GpxTrack, TracksOfTwoVehiclesAreRefused) {
  const std::string gpx = gpx_of(gpx_point("05") + gpx_point("25") + "</trkseg><trkseg>" +
                                 gpx_point("06") + gpx_point("26") + "</trkseg><trkseg>");
  EXPECT_THAT(refusal([&] { parse_gpx_track(gpx, "a.gpx", {}); }), HasSubstr("overlap in time"));
}

TEST(NmeaTrack, ZdaHasTheDateOfGga) {
  const Track track = parse_nmea_track(
      "$GPZDA,123519.00,22,09,2021,00,00\r\n"
      "$GPGGA,123519.00,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,\r\n",
      "a.nmea", {});
  ASSERT_EQ(track.size(), 1u);
  EXPECT_EQ(format_time(track[0].stamp).substr(0, 19), "2021-09-22 12:35:19");
  const Track behind = parse_nmea_track(
      "$GPGGA,123519.00,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,\r\n"
      "$GPZDA,123519.00,22,09,2021,00,00\r\n",
      "a.nmea", {});
  ASSERT_EQ(behind.size(), 1u);
  EXPECT_EQ(behind[0].stamp, track[0].stamp);
}

TEST(NmeaTrack, AfterMidnightItIsTheNextDayAlsoWithoutADate) {
  const Track track = parse_nmea_track(
      "$GPGGA,235959.00,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,\r\n"
      "$GPGGA,000000.00,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,\r\n"
      "$GPGGA,000001.00,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,\r\n",
      "a.nmea", {});
  ASSERT_EQ(track.size(), 3u);
  EXPECT_EQ(track[2].stamp - track[0].stamp, std::chrono::seconds(2));
}

TEST(NmeaTrack, RmcGgaAndGstOfOneTimeAreOneFix) {
  const Track track = parse_nmea_track(
      "$GPGGA,123519.50,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,\r\n"
      "$GPRMC,123519.50,A,4807.038,N,01131.000,W,022.4,084.4,230394,003.1,W\r\n"
      "$GPGST,123519.50,,,,,3.0,4.0,5.0\r\n"
      "$GPRMC,123520.50,V,,,,,,,230394,,\r\n"
      "$GPRMC,123521.50,A,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W*00\r\n",
      "a.nmea", {});
  ASSERT_EQ(track.size(), 1u) << "one is not valid, one has a wrong checksum";
  EXPECT_NEAR(degrees(track[0].position.latitude), 48.0 + 7.038 / 60.0, 1e-9);
  EXPECT_NEAR(degrees(track[0].position.longitude), -(11.0 + 31.0 / 60.0), 1e-9);
  EXPECT_NEAR(track[0].speed, 11.5, 0.05);
  EXPECT_EQ(track[0].hdop, 0.9);
  EXPECT_EQ(track[0].covariance(0, 0), 16.0);
  EXPECT_EQ(track[0].covariance(1, 1), 9.0);
  EXPECT_EQ(track[0].stamp, parse_time("1994-03-23 12:35:19.5"));
  EXPECT_THAT(refusal([] { parse_nmea_track("$GPRMC,1\n", "a.nmea", {}); }),
              HasSubstr("no valid position"));
}

TEST(TumTrack, NeedsAnOrigin) {
  EXPECT_THAT(refusal([] { parse_tum_track("1 0 0 0 0 0 0 1\n", "a.tum", {}); }),
              HasSubstr("--origin"));
  TrackOptions options;
  options.origin = Geodetic{radians(49.0), radians(8.0), 0.0};
  const Track track = parse_tum_track("# x\n1 0 100 5 0 0 0 1\n", "a.tum", options);
  ASSERT_EQ(track.size(), 1u);
  EXPECT_NEAR(degrees(track[0].position.latitude), 49.0009, 1e-5);
  EXPECT_TRUE(std::isnan(track[0].azimuth)) << "which way is forward?";
  EXPECT_THAT(refusal([&] { parse_tum_track("1 2 3\n", "a.tum", options); }), HasSubstr("a.tum:1"));
}

TEST(TumTrack, TheAxisThatLooksWhereThePosesGoIsForward) {
  TrackOptions options;
  options.origin = Geodetic{radians(49.0), radians(8.0), 0.0};
  const auto east_with = [&](const std::string& rotation) {
    std::string text;
    for (int i = 0; i < 5; ++i)
      text += std::to_string(i) + " " + std::to_string(3 * i) + " 0 0 " + rotation + "\n";
    return parse_tum_track(text, "a.tum", options).at(2).azimuth;
  };
  EXPECT_NEAR(east_with("0 0 0 1"), radians(90.0), 1e-6) << "a vehicle's x";
  EXPECT_NEAR(east_with("0.5 -0.5 0.5 -0.5"), radians(90.0), 1e-6) << "a camera's z";
  EXPECT_TRUE(std::isnan(east_with("0 0 1 0"))) << "backwards";
}

TEST(ReadTrack, AFileThatIsMissingOrEmptyIsNamed) {
  maploop::testing::TemporaryFolder folder;
  EXPECT_THAT(refusal([&] { read_track(folder.path() / "none.csv", {}); }), HasSubstr("none.csv"));
  std::ofstream(folder.path() / "a.csv") << "t,lat,lon\n";
  EXPECT_THAT(refusal([&] { read_track(folder.path() / "a.csv", {}); }), HasSubstr("has no fix"));
}

}  // namespace
}  // namespace maploop::match
