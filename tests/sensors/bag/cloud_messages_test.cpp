// Tests the reading of clouds of points.
#include "sensors/bag/cloud_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstring>

#include "tests/sensors/bag/bag_contents.h"

namespace maploop::sensors {
namespace {

using ::testing::HasSubstr;

// A real cloud of another scanner: 64 000 points of 26 bytes with unaligned times since 1970.
TEST(CloudMessage, OfUnalignedPointsHasTimes) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const std::string file = testing::bytes_of(testing::recorded_bag("cloudini_dds_message.bin"));
  RosPointCloud message;
  decode({"/points", "sensor_msgs/PointCloud2", "cdr", ""}, testing::as_bytes(file), message);
  EXPECT_EQ(message.width * message.height, 64'000U);
  EXPECT_EQ(message.point_step, 26U);
  TimedCloud cloud;
  read_cloud(message, cloud);
  ASSERT_GT(cloud.points.size(), 10'000U);
  ASSERT_EQ(cloud.times.size(), cloud.points.size());
  const auto [first, last] = std::ranges::minmax(cloud.times);
  EXPECT_NEAR(to_seconds(last - first), 0.05, 0.001);  // half of a turn, or a scanner of 20 Hz
  EXPECT_LT(std::abs(to_seconds(first - message.header.stamp)), 0.2);
  float first_x = 0.0F;
  std::memcpy(&first_x, message.data.data(), sizeof first_x);
  EXPECT_EQ(cloud.points.front().x, first_x);
}

// A cloud with fields x, y, z and one time of a type.
struct MadeCloud {
  std::string data;
  RosPointCloud message;

  template <class Number>
  void make(const std::vector<Number>& times, std::string_view name, std::uint8_t datatype) {
    const std::size_t step = 12 + sizeof(Number);
    data.assign(times.size() * step, '\0');
    for (std::size_t i = 0; i < times.size(); ++i) {
      const float xyz[] = {1.0F + static_cast<float>(i), 2.0F, 3.0F};
      std::memcpy(data.data() + i * step, xyz, sizeof xyz);
      std::memcpy(data.data() + i * step + sizeof xyz, &times[i], sizeof(Number));
    }
    constexpr std::uint8_t float32 = 7;
    message.header.stamp = from_nanoseconds(1'700'000'000'000'000'000);
    message.height = 1;
    message.width = static_cast<std::uint32_t>(times.size());
    message.fields = {
        {"x", 0, float32, 1}, {"y", 4, float32, 1}, {"z", 8, float32, 1}, {name, 12, datatype, 1}};
    message.point_step = static_cast<std::uint32_t>(step);
    message.row_step = static_cast<std::uint32_t>(data.size());
    message.data = testing::as_bytes(data);
  }
};

TEST(CloudMessage, FindsTheUnitOfTimes) {
  const auto expect_tenth = [](const auto& times, std::uint8_t datatype) {
    MadeCloud made;
    made.make(times, "t", datatype);
    TimedCloud cloud;
    read_cloud(made.message, cloud);
    ASSERT_EQ(cloud.times.size(), 2U);
    EXPECT_NEAR(to_seconds(cloud.times[0] - made.message.header.stamp), 0.0, 1e-6);
    EXPECT_NEAR(to_seconds(cloud.times[1] - made.message.header.stamp), 0.1, 1e-6);
  };
  expect_tenth(std::vector<std::uint32_t>{0, 100'000'000}, 6);             // ns
  expect_tenth(std::vector<float>{0.0F, 0.1F}, 7);                         // s
  expect_tenth(std::vector<float>{0.0F, 100.0F}, 7);                       // ms
  expect_tenth(std::vector<std::int32_t>{0, 100'000}, 5);                  // us
  expect_tenth(std::vector<double>{1'700'000'000.0, 1'700'000'000.1}, 8);  // s since 1970
  expect_tenth(std::vector<double>{1.7e18, 1.7e18 + 1e8}, 8);              // ns since 1970
}

TEST(CloudMessage, WithoutTimesOrWithEqualOnesHasNone) {
  MadeCloud made;
  made.make(std::vector<float>{0.0F, 0.0F}, "t", 7);
  TimedCloud cloud;
  read_cloud(made.message, cloud);
  EXPECT_TRUE(cloud.times.empty());
}

TEST(CloudMessage, RefusesWhatDoesNotFit) {
  const auto refused = [](const auto& change) {
    MadeCloud made;
    made.make(std::vector<float>{0.0F, 0.1F}, "t", 7);
    change(made.message);
    TimedCloud cloud;
    try {
      read_cloud(made.message, cloud);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(refused([](auto& m) { m.width = 3; }), HasSubstr("are not 1 x 3 points"));
  EXPECT_THAT(refused([](auto& m) { m.point_step = 0; }), HasSubstr("of 0 bytes"));
  EXPECT_THAT(refused([](auto& m) { m.fields[2].offset = 13; }), HasSubstr("field z is beyond"));
  EXPECT_THAT(refused([](auto& m) { m.fields[1].name = "w"; }), HasSubstr("no field y"));
  EXPECT_THAT(refused([](auto& m) { m.height = m.width = 0; }), HasSubstr("no finite point"));
  EXPECT_THAT(refused([](auto& m) {
                m.height = 2;
                m.width = 1;
                m.row_step = 0xffffffff;
              }),
              HasSubstr("rows of 4294967295 bytes"));
}

// A driver of Livox's scanners sends points of 19 bytes, which ROS 2 pads to 20.
TEST(CloudMessage, OfLivoxIsReadInBothEncodings) {
  for (const std::string encoding : {"ros1", "cdr"}) {
    SCOPED_TRACE(encoding);
    const bool cdr = encoding == "cdr";
    std::string bytes = cdr ? std::string("\0\1\0\0", 4) : std::string();
    const auto put = [&](auto value) {
      const std::size_t begin = cdr ? 4 : 0;
      while (cdr && (bytes.size() - begin) % sizeof value != 0) bytes.push_back('\0');
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    if (!cdr) put(std::uint32_t{0});    // number
    put(std::uint32_t{1'700'000'000});  // stamp
    put(std::uint32_t{0});
    put(std::uint32_t{cdr ? 2U : 1U});  // frame
    bytes += cdr ? std::string("l\0", 2) : "l";
    put(std::uint64_t{1'700'000'000'000'000'000});
    put(std::uint32_t{3});
    for (int i = 0; i < 4; ++i) put(std::uint8_t{0});
    put(std::uint32_t{3});
    for (int i = 0; i < 3; ++i) {
      put(static_cast<std::uint32_t>(i * 50'000'000));
      for (const float v : {1.0F + static_cast<float>(i), 2.0F, 3.0F}) put(v);
      for (const int v : {200, 16, 1}) put(static_cast<std::uint8_t>(v));
    }
    RosPointCloud message;
    decode({"/livox/lidar", "livox_ros_driver2/CustomMsg", encoding, ""}, testing::as_bytes(bytes),
           message);
    TimedCloud cloud;
    read_cloud(message, cloud);
    ASSERT_EQ(cloud.points.size(), cdr ? 2U : 3U) << "cdr's last point is not padded";
    ASSERT_EQ(cloud.times.size(), cloud.points.size());
    EXPECT_EQ(cloud.points[1].x, 2.0F);
    EXPECT_EQ(cloud.points[1].reflectance, 200.0F);
    EXPECT_EQ(cloud.times[1] - cloud.times[0], std::chrono::milliseconds(50));
    bytes.resize(bytes.size() - 21);
    EXPECT_THROW(decode({"/l", "livox_ros_driver2/CustomMsg", encoding, ""},
                        testing::as_bytes(bytes), message),
                 std::invalid_argument);
  }
}

}  // namespace
}  // namespace maploop::sensors
