// Which scan goes with which visual motion, whatever the phase of the scanner's turns.
#include "runtime/vehicle/stages/lidar_stage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <thread>
#include <variant>
#include <vector>

#include "runtime/vehicle/graph/graph.h"
#include "tests/runtime/vehicle/fake_sensors.h"

namespace maploop::vehicle {
namespace {

using std::chrono::milliseconds;
using testing::drive_start;

constexpr int count = 40;
constexpr Duration turn = milliseconds(100);

Time image(int i) {
  return drive_start + i * turn;
}

VisualMotion visual(int i, Duration delay = {}) {
  VisualMotion m;
  m.sequence = static_cast<std::uint64_t>(i);
  m.stamp = image(i);
  m.from = image(i - 1);
  m.available = m.stamp + delay + milliseconds(5) + stages::stereo.budget;
  m.status = i == 0 ? OdometryStatus::first_frame : OdometryStatus::ok;
  m.translation.x() = 1.0;
  m.covariance = 1e-4 * Eigen::Matrix<double, 6, 6>::Identity();
  return m;
}

// Of a turn that ends so long behind image i; without points, so that it says nothing itself.
LidarScan scan(int i, Duration end_behind, Duration late = {}) {
  LidarScan s;
  s.sequence = static_cast<std::uint64_t>(i);
  s.end = image(i) + end_behind;
  s.start = s.end - turn;
  s.stamp = s.end - turn / 2;
  s.available = s.end + late;
  return s;
}

using Input = std::variant<VisualMotion, LidarScan>;

Time available(const Input& input) {
  return std::visit([](const auto& v) { return v.available; }, input);
}

struct Sent {
  std::vector<LidarMotion> lidar;
  std::vector<RelativeMotion> odometry;
};

Sent run(std::vector<Input> inputs, const SensorDelays& delays = {}) {
  std::stable_sort(inputs.begin(), inputs.end(),
                   [](const Input& a, const Input& b) { return available(a) < available(b); });
  Rings rings(rings::all, {"velodyne", "stereo", "lidar", "fusion", "publisher"}, {});
  runtime::Edge<LidarScan>& scans = *rings.outputs(rings::velodyne_lidar).rings().front();
  runtime::Edge<VisualMotion>& visual = *rings.outputs(rings::stereo_lidar).rings().front();
  runtime::Edge<LidarMotion>& lidar = *rings.consumer(rings::lidar_publisher);
  runtime::Edge<RelativeMotion>& odometry = *rings.consumer(rings::lidar_fusion);
  LidarStage stage(rings, lidar::VisualLidarOdometer(Eigen::Isometry3d::Identity(), {}), delays);
  runtime::DataClock clock = runtime::DataClock::virtual_time();
  const std::stop_token stop;
  std::thread thread([&] { stage.run(clock, drive_start, stop); });
  for (const Input& input : inputs) {
    if (const auto* motion = std::get_if<VisualMotion>(&input)) {
      visual.push(*motion, stop);
    } else {
      scans.push(std::get<LidarScan>(input), stop);
    }
    visual.promise(available(input));
    scans.promise(available(input));
  }
  visual.finish();
  scans.finish();
  thread.join();
  Sent sent;
  for (; lidar.front() != nullptr; lidar.pop()) sent.lidar.push_back(*lidar.front());
  for (; odometry.front() != nullptr; odometry.pop()) sent.odometry.push_back(*odometry.front());
  return sent;
}

// Each where the one before ended, in the order in which they become available.
void expect_chain(const std::vector<RelativeMotion>& motions) {
  for (std::size_t i = 2; i < motions.size(); ++i) {
    EXPECT_EQ(motions[i].from, motions[i - 1].stamp) << i;
    EXPECT_GE(motions[i].available, motions[i - 1].available) << i;
  }
}

// Each image, and the scan that make_scan(i) makes of its turn.
template <class MakeScan>
std::vector<Input> with_scans(MakeScan make_scan, Duration image_delay = {}) {
  std::vector<Input> inputs;
  for (int i = 0; i < count; ++i) {
    inputs.emplace_back(visual(i, image_delay));
    inputs.emplace_back(make_scan(i));
  }
  return inputs;
}

class ScansAndImages : public ::testing::TestWithParam<int> {};  // delay of the images, ms

TEST_P(ScansAndImages, OfOneTurnGoTogetherInAnyPhase) {
  const Duration delay = milliseconds(GetParam());
  for (const int behind : {1, 30, 50, 56, 70, 99}) {  // ms
    SCOPED_TRACE(behind);
    const Sent sent =
        run(with_scans([&](int i) { return scan(i, milliseconds(behind)); }, delay), {delay});
    ASSERT_EQ(sent.lidar.size(), static_cast<std::size_t>(count));
    // The first image cannot know of a scanner; then its scan may have a motion of its own.
    EXPECT_LE(sent.odometry.size(), sent.lidar.size() + 1);
    expect_chain(sent.odometry);
    for (int i = 1; i < count; ++i) {
      EXPECT_EQ(sent.lidar[static_cast<std::size_t>(i)].stamp, image(i));
      EXPECT_EQ(sent.lidar[static_cast<std::size_t>(i)].status, OdometryStatus::too_few_features);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Delays, ScansAndImages, ::testing::Values(0, 30, 45));

TEST(LidarStage, ADriftingScannerBreaksNoChain) {
  const Sent sent = run(with_scans([](int i) {
    return scan(i, milliseconds(40) + i * milliseconds(4));  // more than a turn
  }));
  // The turns' gaps are one turn long in all: one image without a scan, one scan without an image.
  EXPECT_EQ(sent.odometry.size(), static_cast<std::size_t>(count) + 1);
  expect_chain(sent.odometry);
}

TEST(LidarStage, ASilentScannerHoldsNothingUp) {
  std::vector<Input> inputs;
  inputs.reserve(count);
  for (int i = 0; i < count; ++i) inputs.emplace_back(visual(i));
  const Sent sent = run(inputs);
  ASSERT_EQ(sent.odometry.size(), static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    EXPECT_EQ(sent.odometry[static_cast<std::size_t>(i)].available,
              visual(i).available + stages::lidar.budget);
  }
}

TEST(LidarStage, AScanThatComesTooLateIsLeftOutAndBreaksNoChain) {
  const Sent sent =
      run(with_scans([](int i) { return scan(i, milliseconds(70), milliseconds(80)); }));
  // Only the first comes before any motion.
  EXPECT_EQ(sent.odometry.size(), static_cast<std::size_t>(count) + 1);
  expect_chain(sent.odometry);
  for (std::size_t i = 1; i < sent.lidar.size(); ++i)
    EXPECT_EQ(sent.lidar[i].status, OdometryStatus::bad_input) << i;
}

TEST(LidarStage, WhereScansOrImagesAreMissingTheOtherGoesOn) {
  std::vector<Input> inputs;
  for (int i = 0; i < count; ++i) {
    if (i < 10 || i >= 20) inputs.emplace_back(visual(i));
    if (i < 15 || i >= 30) inputs.emplace_back(scan(i, milliseconds(60)));
  }
  const Sent sent = run(inputs);
  for (std::size_t i = 1; i < sent.odometry.size(); ++i) {
    EXPECT_GE(sent.odometry[i].available, sent.odometry[i - 1].available);
    EXPECT_GT(sent.odometry[i].stamp, sent.odometry[i - 1].stamp);
  }
  EXPECT_EQ(sent.odometry.back().stamp, image(count - 1));
  EXPECT_EQ(sent.odometry.size(), static_cast<std::size_t>(count - 4));
}

}  // namespace
}  // namespace maploop::vehicle
