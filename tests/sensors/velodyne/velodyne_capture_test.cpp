// These tests read real packets: a VLP-16 on a moving car, a standing HDL-64E, a VLP-16's inside an
// LCM log.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "msgs/lcm/log/log_reader.h"
#include "sensors/velodyne/capture_source.h"
#include "tests/sensors/velodyne/made_calibration.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {
namespace {

using maploop::testing::error_of;
using ::testing::HasSubstr;

std::vector<LidarScan> scans_of(VelodyneCapture& capture) {
  std::vector<LidarScan> scans(1);
  while (capture.next(scans.back())) scans.emplace_back();
  scans.pop_back();
  return scans;
}

TEST(VelodyneCapture, Vlp16OnAMovingCar) {
  MAPLOOP_REQUIRE_REAL_DATA();
  VelodyneCapture capture(testing::real_data() / "velodyne/vlp16_moving_car.pcap", {});
  EXPECT_EQ(capture.model(), VelodyneModel::vlp16);
  const auto scans = scans_of(capture);
  const VelodyneCounts& counts = capture.decoder().counts();
  EXPECT_EQ(counts.data, 291U);
  EXPECT_EQ(counts.positions, 56U);
  EXPECT_EQ(counts.lost, 0U);
  EXPECT_EQ(counts.late, 0U);
  EXPECT_EQ(capture.decoder().turns().broken, 0U);
  ASSERT_EQ(scans.size(), 2U);  // 0.38 s from 230 degrees on
  for (const LidarScan& scan : scans) {
    EXPECT_NEAR(to_seconds(scan.end - scan.start), 0.1, 0.002);
    EXPECT_NEAR(to_seconds(scan.stamp - scan.start), 0.05, 0.001);
    EXPECT_GT(scan.points.size(), 15'000U);
  }
  EXPECT_EQ(scans[1].start, scans[0].end);
  // The receiver's $GPRMC is of 21:41:06 and its clock is 1.1 s later; the capturing host's is
  // behind.
  const auto offset = capture.decoder().clock().gps_offset();
  ASSERT_TRUE(offset);
  EXPECT_NEAR(to_seconds(*offset), 1.406, 0.005);
  ASSERT_EQ(capture.report().refused, 1U);
  EXPECT_THAT(capture.report().refusals[0].reason, HasSubstr("truncated"));
}

TEST(VelodyneCapture, Hdl64eWithoutAClockIsStampedByArrival) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const testing::TemporaryFolder folder;
  const auto file = testing::real_data() / "velodyne/hdl64e_static.pcap";
  EXPECT_THROW(VelodyneCapture(file, {}), std::invalid_argument);  // each unit has its own lasers
  write_calibration(folder.path() / "db.xml");
  VelodyneCapture capture(file, {{}, folder.path() / "db.xml"});
  EXPECT_EQ(capture.model(), VelodyneModel::hdl64e);
  const auto scans = scans_of(capture);
  EXPECT_EQ(capture.decoder().counts().data, 306U);
  EXPECT_FALSE(capture.decoder().clock().has_device_time());
  // The 0.12 s begin at 303 degrees, so no turn from rear to rear is complete.
  EXPECT_EQ(scans.size(), 0U);
}

// The events are those of the go-kart's channel, without its struct's fingerprint and length.
TEST(VelodyneCapture, PacketsInsideAnLcmLog) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const schema::Schema unknown({});
  lcm_log::LogReader reader(testing::real_data() / "lcm/vlp16_and_wheels.lcm", unknown);
  VelodyneDecoder decoder(VelodyneModel::vlp16, factory_lasers(VelodyneModel::vlp16));
  std::vector<LidarScan> scans(1);
  for (auto item = reader.next(); item != lcm_log::LogReader::Item::end; item = reader.next()) {
    if (item != lcm_log::LogReader::Item::event) continue;
    const auto& event = reader.event();
    if (event.channel.find("vlp16") == std::string::npos || event.data.size() < 12) continue;
    const std::span<const std::uint8_t> data(event.data);
    if (decoder.add(data.subspan(12), Time(std::chrono::microseconds(event.time_us)),
                    scans.back())) {
      scans.emplace_back();
    }
  }
  EXPECT_EQ(decoder.counts().data, 120U);
  EXPECT_EQ(decoder.counts().lost, 0U);
}

TEST(VelodyneCapture, ReportsWhatIsWrongWithAFile) {
  const testing::TemporaryFolder folder;
  const auto message = [](const std::filesystem::path& file) {
    return error_of([&] { VelodyneCapture capture(file, {}); });
  };
  EXPECT_THAT(message(folder.path() / "none.pcap"), HasSubstr("is not a file"));
  std::ofstream(folder.path() / "text.pcap") << "no capture at all, but long enough to be one";
  EXPECT_THAT(message(folder.path() / "text.pcap"), HasSubstr("is not a capture"));
}

TEST(VelodyneCalibration, ReportsWhatIsWrongWithAFile) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "db.xml";
  const auto message = [&] {
    return error_of([&] { read_velodyne_calibration(file, VelodyneModel::hdl64e); });
  };
  EXPECT_THAT(message(), HasSubstr(file.string()));
  write_calibration(file);
  EXPECT_EQ(message(), "");
  write_calibration(file, 63);
  EXPECT_THAT(message(), HasSubstr("has no laser 63"));
  std::ofstream(file) << "<boost_serialization>";
  EXPECT_NE(message(), "");
}

}  // namespace
}  // namespace maploop::sensors
