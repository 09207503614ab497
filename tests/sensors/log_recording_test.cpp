// These tests damage messages of a log where a reader of logs cannot detect it.
#include "sensors/replay/log_recording.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "msgs/lcm/channel_names.h"
#include "tests/sensors/small_drive.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {
namespace {

using maploop::testing::error_of;
using ::testing::HasSubstr;

// This is a small log of every sensor; its IMU has three messages.
class DamagedLog : public ::testing::Test {
 protected:
  DamagedLog() {
    std::ifstream in(testing::source("tests/fuzz/corpus/recording/sensors.lcmlog"),
                     std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(in), {});
  }

  // Returns where the data of the n-th message of a channel begin.
  char* message(const std::string& channel, int n) {
    std::size_t at = 0;
    for (int i = 0; i <= n; ++i) at = bytes_.find(channel, at) + channel.size();
    return &bytes_[at];
  }

  LogRecording recording() const {
    const auto file = folder_.path() / "damaged.lcmlog";
    std::ofstream(file, std::ios::binary) << bytes_;
    return LogRecording(file);
  }

  template <class T>
  SourceReport read(std::string_view channel) const {
    const auto source = recording().source<T>(channel);
    read_all(source);
    return source->report();
  }

  std::string bytes_;
  testing::TemporaryFolder folder_;
};

constexpr int fingerprint = 8, header = 32, stamp = fingerprint + 8, available = stamp + 8;

TEST_F(DamagedLog, IsWholeAtFirst) {
  EXPECT_EQ(read<ImuSample>(channel_names::imu).delivered, 3u);
  EXPECT_EQ(read<LidarScan>(channel_names::velodyne).delivered, 1u);
  EXPECT_EQ(read<StereoPair>(channel_names::camera).delivered, 1u);
}

// LCM's own code would trust such a size.
TEST_F(DamagedLog, AMessageWithAWrongSizeIsLeftOut) {
  for (const std::string& size :
       {std::string("\xff\xff\xff\xff"), std::string("\x7f\xff\xff\xff")}) {
    size.copy(message("VELODYNE", 0) + fingerprint + header + 16, size.size());
    size.copy(message("CAMERA", 0) + fingerprint + header + 8, size.size());
    const SourceReport scans = read<LidarScan>(channel_names::velodyne),
                       pairs = read<StereoPair>(channel_names::camera);
    EXPECT_EQ(scans.delivered + pairs.delivered, 0u);
    ASSERT_EQ(scans.refusals.size(), 1u);
    EXPECT_THAT(scans.refusals[0].reason, HasSubstr("VELODYNE, event "));
    ASSERT_EQ(pairs.refusals.size(), 1u);
  }
}

TEST_F(DamagedLog, ACalibrationOfAnotherTypeIsOfAnotherVersion) {
  message("CALIBRATION", 0)[0] ^= 1;  // its fingerprint
  EXPECT_THAT(error_of([&] { recording(); }), HasSubstr("from another version"));
}

TEST_F(DamagedLog, WithoutImagesTheSensorThatBeginsFirstDefinesTheBeginning) {
  const Time with_images = recording().first_stamp();
  message("GNSS_FIX", 0)[stamp + 3] -= 1;  // 2^32 ns earlier
  EXPECT_EQ(recording().first_stamp(), with_images);
  for (const std::string channel : {"CAMERA", "ODOMETRY"}) {
    for (std::size_t at = 0; (at = bytes_.find(channel, at)) != std::string::npos; ++at)
      bytes_[at] = 'X';
  }
  const LogRecording alone = recording();
  EXPECT_EQ(alone.first_stamp(),
            read_all(alone.source<GnssFix>(channel_names::gnss_fix)).front().stamp);
  EXPECT_LT(alone.first_stamp(), with_images);
}

TEST_F(DamagedLog, OneWrongStampCostsOneMessage) {
  constexpr char a_lifetime = 0x20;  // bit 61 of nanoseconds
  for (const int n : {1, 2}) {
    message("IMU", n)[stamp] ^= a_lifetime;
    message("IMU", n)[available] ^= a_lifetime;
    const SourceReport report = read<ImuSample>(channel_names::imu);
    EXPECT_EQ(report.delivered, 2u) << n;
    EXPECT_EQ(report.refused, 1u) << n;
    message("IMU", n)[available] ^= a_lifetime;
    EXPECT_EQ(read<ImuSample>(channel_names::imu).refused, 1u) << "the stamp alone";
    message("IMU", n)[stamp] ^= a_lifetime;
  }
}

}  // namespace
}  // namespace maploop::sensors
