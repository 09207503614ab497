// These tests decode an Xsens unit: made messages, and a pseudo-terminal for its serial line.
#include "sensors/imu/xsens.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "sensors/live/live_sensors.h"
#include "tests/sensors/live/lines.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {
namespace {

using std::chrono::milliseconds;
using testing::PseudoTerminal;
using testing::wait_for;
using testing::wait_until_open;

std::string big_endian(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> (8 * i) & 0xffU);
  return text;
}

std::string item(unsigned id, const std::string& data) {
  return big_endian(id, 2) + static_cast<char>(data.size()) + data;
}

std::string message(std::uint8_t id, const std::string& data) {
  std::string m = "\xff";
  m += static_cast<char>(id);
  if (data.size() < 255) {
    m += static_cast<char>(data.size());
  } else {
    m += '\xff' + big_endian(data.size(), 2);
  }
  m += data;
  unsigned sum = 0;
  for (const char c : m) sum += static_cast<unsigned char>(c);
  return '\xfa' + m + static_cast<char>(-sum & 0xffU);
}

std::string floats(double x, double y, double z) {
  std::string text;
  for (const double v : {x, y, z})
    text += big_endian(std::bit_cast<std::uint32_t>(static_cast<float>(v)), 4);
  return text;
}

std::string sample(std::uint32_t ticks, double forward = 0.5, double left = -0.25,
                   double yaw_rate = 0.125) {
  return message(0x36, item(0x1020, big_endian(7, 2)) + item(0x1060, big_endian(ticks, 4)) +
                           item(0x4020, floats(forward, left, 9.81)) +
                           item(0x8020, floats(0.0, 0.0, yaw_rate)) +
                           item(0xe020, big_endian(0, 4)));
}

std::vector<XsensSample> decode(XsensDecoder& decoder, const std::string& text, std::size_t piece) {
  std::vector<XsensSample> samples;
  XsensSample s;
  for (std::size_t i = 0; i < text.size(); i += piece) {
    const std::string part = text.substr(i, piece);
    std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(part.data()),
                                        part.size());
    while (decoder.next(bytes, s)) samples.push_back(s);
  }
  return samples;
}

TEST(Xsens, SamplesInEveryPrecisionAndPieceByPiece) {
  const auto fixed12 = [](double v) {
    return big_endian(
        static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(v * 1048576.0))), 4);
  };
  const auto fixed16 = [](double v) {
    const double whole = std::floor(v);
    return big_endian(static_cast<std::uint64_t>(std::llround((v - whole) * 4294967296.0)), 4) +
           big_endian(static_cast<std::uint64_t>(static_cast<std::int64_t>(whole)), 2);
  };
  const auto whole = [](double v) { return big_endian(std::bit_cast<std::uint64_t>(v), 8); };
  const auto with = [&](unsigned format, auto&& number) {
    const auto three = [&](double x, double y, double z) {
      return number(x) + number(y) + number(z);
    };
    return message(0x36, item(0x1060, big_endian(100 * format, 4)) +
                             item(0x4020 + format, three(0.5, -0.25, 9.8125)) +
                             item(0x8020 + format, three(0.0, 0.0, -1.125)));
  };
  const std::string text =
      sample(0, 0.5, -0.25, -1.125) + with(1, fixed12) + with(2, fixed16) + with(3, whole);
  for (const std::size_t piece : {1UL, 13UL, 1000UL}) {
    XsensDecoder decoder;
    const auto samples = decode(decoder, text, piece);
    ASSERT_EQ(samples.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(samples[i].time, milliseconds(10 * i));
      EXPECT_DOUBLE_EQ(samples[i].specific_force[0], 0.5);
      EXPECT_DOUBLE_EQ(samples[i].specific_force[1], -0.25);
      EXPECT_DOUBLE_EQ(samples[i].rate[2], -1.125);
    }
    EXPECT_EQ(decoder.counts().damaged, 0u);
  }
}

TEST(Xsens, ItsClockContinuesWhenItsTicksRestart) {
  XsensDecoder decoder;
  const auto samples = decode(decoder, sample(0xffffffce) + sample(50), 7);
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_EQ(samples[1].time - samples[0].time, milliseconds(10));
}

TEST(Xsens, DamageIsPassedOverAndCounted) {
  std::string broken = sample(100);
  broken[20] = static_cast<char>(broken[20] ^ 4);
  const std::string without_rate =
      message(0x36, item(0x1060, big_endian(0, 4)) + item(0x4020, floats(0, 0, 0)));
  const std::string not_finite =
      message(0x36, item(0x1060, big_endian(0, 4)) + item(0x4020, floats(std::nan(""), 0, 0)) +
                        item(0x8020, floats(0, 0, 0)));
  const std::string other = message(0x3e, std::string(300, 'x'));  // WakeUp, made long
  XsensDecoder decoder;
  const auto samples = decode(decoder,
                              "text\xfa" + sample(0) + broken + without_rate + not_finite + other +
                                  "\xfa\xff\x36\xff\xff\xff" + sample(200),
                              11);
  EXPECT_EQ(samples.size(), 2u);
  EXPECT_GE(decoder.counts().damaged, 3u);
  EXPECT_EQ(decoder.counts().incomplete, 2u);
  std::mt19937 random(3);
  std::string garbage(200'000, '\0');
  for (char& c : garbage) c = static_cast<char>(random());
  decode(decoder, garbage, 997);
  EXPECT_EQ(decode(decoder, std::string(600, '\0') + sample(300), 64).size(), 1u);
}

TEST(LiveXsens, SurvivesUnpluggingOfItsSerialLine) {
  const testing::TemporaryFolder folder;
  const HostClock clock;
  const auto device = folder.path() / "imu";
  const auto imu =
      listen_to_xsens(parse_endpoint("serial://" + device.string()), milliseconds(5), clock);
  ImuSample s;
  EXPECT_FALSE(imu->wait(s, milliseconds(5)));
  Time last = Time::min();
  for (std::uint32_t plugged = 0; plugged < 2; ++plugged) {
    {
      const PseudoTerminal line(device);
      ASSERT_TRUE(wait_until_open(*imu, true));
      const std::uint32_t ticks = 20'000 * plugged;
      line.send(sample(ticks).substr(30) + sample(ticks + 100) + sample(ticks + 200));
      for (int k = 0; k < 2; ++k) {
        ASSERT_TRUE(wait_for(*imu, s));
        EXPECT_EQ(s.specific_force_forward, 0.5);
        EXPECT_EQ(s.specific_force_left, -0.25);
        EXPECT_EQ(s.yaw_rate, 0.125);
        EXPECT_GT(s.stamp, last);
        EXPECT_LE(s.stamp, s.available - milliseconds(5));
        last = s.stamp;
      }
    }
    ASSERT_TRUE(wait_until_open(*imu, false));
  }
  EXPECT_EQ(imu->report().connection.opened, 2u);
  EXPECT_EQ(imu->report().delivered, 4u);
}

}  // namespace
}  // namespace maploop::sensors
