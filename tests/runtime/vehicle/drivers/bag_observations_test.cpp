// Tests that a receiver's raw messages in a recording are what the receiver's own file is.
#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/input_file.h"
#include "ppp/readers/streams/ubx_frames.h"
#include "runtime/vehicle/drivers/recording.h"
#include "sensors/bag/written_bytes.h"
#include "tests/sensors/bag/made_mcap.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

using sensors::bag::number;
using ::testing::HasSubstr;

constexpr std::uint8_t rxm = 0x02, rawx = 0x15, sfrbx = 0x13;
constexpr std::uint64_t start = 1'600'000'000'000'000'000;  // ns

// The payloads of five minutes of a receiver, and a subframe.
class BagObservations : public ::testing::Test {
 protected:
  void SetUp() override {
    MAPLOOP_REQUIRE_REAL_DATA();
    bytes_ = read_text(maploop::testing::real_data() / "gnss/parser_samples/F9T-L2-5min.ubx.gz",
                       std::size_t{1} << 30U);
    ppp::UbxFrames frames(bytes_);
    for (ppp::UbxFrame frame; frames.next(frame);) {
      if (frame.message_class == rxm && (frame.id == rawx || frame.id == sfrbx))
        frames_.push_back(frame);
    }
    ASSERT_GT(frames_.size(), 250U);
    frames_.push_back({rxm, sfrbx, subframe_, 0});
  }

  // As ROS 1 writes a payload: with the number of the elements of its list.
  static std::string ros1(const ppp::UbxFrame& frame) {
    const std::size_t head = frame.id == rawx ? 16 : 8, element = frame.id == rawx ? 32 : 4;
    const auto count = static_cast<std::uint32_t>((frame.payload.size() - head) / element);
    return std::string(frame.payload.substr(0, head)) + number(count) +
           std::string(frame.payload.substr(head));
  }

  // As CDR does: behind the count of 16 + 4 bytes, numbers of eight bytes begin at 24.
  static std::string cdr(const ppp::UbxFrame& frame) {
    std::string data = ros1(frame);
    if (frame.id == rawx) data.insert(20, 4, '\0');
    return std::string("\0\1\0\0", 4) + data;
  }

  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << content;
    return folder_.path() / name;
  }

  std::filesystem::path mcap(const std::string& encoding, bool only_subframes = false) const {
    using namespace made_mcap;
    const bool is_cdr = encoding == "cdr";
    const std::string definition =  // of ROS 2, which has other names
        "float64 rcv_tow\nuint16 week\nint8 leap_s\nuint8 num_meas\nuint8 rec_stat\n"
        "uint8 version\nuint8[2] reserved1\nRxmRAWXMeas[] meas\n";
    std::string records = schema(1, is_cdr ? "ublox_msgs/msg/RxmRAWX" : "ublox_msgs/RxmRAWX",
                                 is_cdr ? "ros2msg" : "ros1msg", definition) +
                          channel(1, "/ublox/rxmraw", encoding) +
                          schema(2, is_cdr ? "ublox_msgs/msg/RxmSFRBX" : "ublox_msgs/RxmSFRBX",
                                 is_cdr ? "ros2msg" : "ros1msg", "") +
                          channel(2, "/ublox/rxmsfrb", encoding);
    std::uint64_t time = start;
    if (cut_message_) records += message(1, time, "too short");
    for (const ppp::UbxFrame& frame : frames_) {
      if (only_subframes && frame.id == rawx) continue;
      records +=
          message(frame.id == rawx ? 1 : 2, time += 1'000'000, is_cdr ? cdr(frame) : ros1(frame));
    }
    return write("a.mcap", file(records));
  }

  static Recording opened(const std::filesystem::path& path) {
    VehicleConfig config;  // the ephemerides of another day are enough to open it
    config.ppp.products = {
        (maploop::testing::real_data() / "gnss/kamakura_kinematic/SEPT2650.21P.gz").string()};
    return open_recording(path, config);
  }

  static std::vector<Time> epochs_of(const std::filesystem::path& path) {
    const Recording recording = opened(path);
    const Sensors sensors = recording.sensors(Time::min());
    std::vector<Time> stamps;
    if (sensors.epochs == nullptr) return stamps;
    for (GnssEpoch epoch; sensors.epochs->next(epoch);) {
      stamps.push_back(epoch.stamp);
      EXPECT_FALSE(epoch.epoch.satellites.empty());
    }
    return stamps;
  }

  std::string bytes_;
  const std::string subframe_ = std::string(8 + 10 * 4, '\0');  // the file has none
  std::vector<ppp::UbxFrame> frames_;
  bool cut_message_ = false;  // whether the recording begins with one
  maploop::testing::TemporaryFolder folder_;
};

TEST_F(BagObservations, AreThoseOfTheReceiversFile) {
  const auto expected = epochs_of(write("a.ubx", bytes_));
  ASSERT_GT(expected.size(), 250U);
  for (const char* encoding : {"ros1", "cdr"})
    EXPECT_EQ(epochs_of(mcap(encoding)), expected) << encoding;
}

TEST_F(BagObservations, AMessageThatCannotBeDecodedIsCounted) {
  using ::testing::Contains, ::testing::Not;
  EXPECT_THAT(opened(mcap("ros1")).notes, Not(Contains(HasSubstr("raw messages"))));
  cut_message_ = true;
  const auto path = mcap("ros1");
  EXPECT_THAT(
      opened(path).notes,
      Contains(HasSubstr("1 of the receiver's raw messages are not used, the first because: "
                         "/ublox/rxmraw, message 1: ")));
  EXPECT_GT(epochs_of(path).size(), 250U);
}

TEST_F(BagObservations, SubframesAloneAreRefusedWithWhatIsMissing) {
  EXPECT_THAT(maploop::testing::error_of([&] { epochs_of(mcap("ros1", true)); }),
              HasSubstr("no messages of a sensor"));
}

}  // namespace
}  // namespace maploop::vehicle
