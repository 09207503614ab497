// The fusion thread allocates nothing: ticks, rings, meters and the trace included.
#include <gtest/gtest.h>

#include <cstdlib>
#include <stop_token>
#include <thread>

#include "runtime/core/trace.h"
#include "runtime/vehicle/graph/graph.h"
#include "runtime/vehicle/stages/fusion_stage.h"
#include "tests/support/counted_allocations.h"

namespace maploop::vehicle {
namespace {

constexpr Time start = from_nanoseconds(1'317'042'651'000'000'000);
constexpr std::int64_t seconds = 20;

ImuSample inertial_sample(std::int64_t i) {
  ImuSample sample;
  sample.sequence = static_cast<std::uint64_t>(i);
  sample.available = start + i * milliseconds(10);
  sample.stamp = sample.available - milliseconds(60);
  sample.specific_force_forward = sample.specific_force_left = 0.0;
  sample.yaw_rate = 0.0;
  return sample;
}

GnssFix fix(std::int64_t i) {
  GnssFix fix;
  fix.sequence = static_cast<std::uint64_t>(i);
  fix.stamp = fix.velocity_stamp = fix.available = start + i * milliseconds(1000);
  fix.position = {radians(49.0), radians(8.4), 110.0};
  fix.position_covariance = Eigen::Matrix3d::Identity();
  fix.velocity_enu = {0.0, 10.0, 0.0};
  fix.velocity_covariance = 0.01 * Eigen::Matrix3d::Identity();
  return fix;
}

// 10 m/s straight on; each tenth one is refused.
RelativeMotion motion(std::int64_t i) {
  RelativeMotion motion;
  motion.sequence = static_cast<std::uint64_t>(i);
  motion.stamp = start + i * milliseconds(100);
  motion.from = motion.stamp - milliseconds(100);
  motion.available = motion.stamp + milliseconds(55);
  motion.status = i % 10 == 9 ? OdometryStatus::too_few_inliers : OdometryStatus::ok;
  motion.translation = {1.0, 0.0, 0.0};
  motion.covariance = 1e-4 * Eigen::Matrix<double, 6, 6>::Identity();
  return motion;
}

// Everything in the order of `available`, as drivers and odometry send it.
void feed(Rings& rings) {
  runtime::Edge<ImuSample>& imu = *rings.outputs(rings::imu_fusion).rings().front();
  runtime::Edge<GnssFix>& gnss = *rings.outputs(rings::gnss_fusion).rings().front();
  runtime::Edge<RelativeMotion>& odometry = *rings.outputs(rings::odometry_fusion).rings().front();
  for (std::int64_t i = 0; i < seconds * 100; ++i) {
    if (i % 100 == 0) gnss.push(fix(i / 100), {});
    imu.push(inertial_sample(i), {});
    if (i % 10 == 6) odometry.push(motion(i / 10), {});
    const Time sent = start + i * milliseconds(10);
    gnss.promise(sent);
    imu.promise(sent);
    odometry.promise(sent);
  }
  gnss.finish();
  imu.finish();
  odometry.finish();
}

TEST(FusionStageAllocation, TheWholeThreadAllocatesNothing) {
  if (!testing::counts_allocations()) GTEST_SKIP() << "the sanitizer owns malloc";
  Rings rings(rings::all, {"imu", "gnss", "odometry", "fusion", "publisher"}, {});
  runtime::Edge<FusedState>& nav_states = *rings.consumer(rings::fusion_publisher);
  runtime::Edge<FusedState>& image_states = *rings.consumer(rings::image_states);
  runtime::Edge<CalibrationReport>& calibrations = *rings.consumer(rings::calibration_publisher);
  FusionStage stage(rings,
                    fusion::GuardedFilter(fusion::ReducedImuFilter(fusion::FusionParameters{})),
                    fusion::ProtectionMonitor(), stages::stereo.budget);
  runtime::Tracer tracer({});
  runtime::TraceBuffer& trace = tracer.thread("fusion");
  stage.trace_to(&trace);
  runtime::DataClock clock = runtime::DataClock::paced(20.0);
  clock.start(start, milliseconds(10));

  long allocated = -1;
  std::thread fusion_thread([&] {
    const long before = testing::thread_allocations();
    stage.run(clock, start, {});
    allocated = testing::thread_allocations() - before;
    stage.finish();
  });
  std::thread feeder([&] { feed(rings); });
  std::uint64_t states = 0, images = 0, calibrated = 0;
  NavStatus status{};
  while (nav_states.promised() != Time::max() || nav_states.front() != nullptr) {
    while (const NavState* state = nav_states.front()) {
      status = state->status;
      ++states;
      nav_states.pop();
    }
    for (; image_states.front() != nullptr; image_states.pop()) ++images;
    for (; calibrations.front() != nullptr; calibrations.pop()) ++calibrated;
    std::this_thread::sleep_for(milliseconds(1));
  }
  feeder.join();
  fusion_thread.join();

  EXPECT_EQ(allocated, 0);
  EXPECT_GE(states, static_cast<std::uint64_t>(seconds * 100));
  EXPECT_GT(images, 0u);
  EXPECT_EQ(calibrated, (states + CalibrationReport::every - 1) / CalibrationReport::every);
  EXPECT_EQ(status, NavStatus::aided);
  EXPECT_EQ(stage.filter_report().status.refused_for(fusion::Reason::odometry_not_ok), 20u);
  EXPECT_GT(trace.recorded(), 5 * states / 2);
  EXPECT_EQ(trace.dropped(), 0u);
}

TEST(FusionStageAllocation, TheCountIsTheThreadsOwn) {
  if (!testing::counts_allocations()) GTEST_SKIP() << "the sanitizer owns malloc";
  const long before = testing::thread_allocations();
  long of_other = 0;
  void* volatile memory = nullptr;
  std::thread other([&] {
    const long at_start = testing::thread_allocations();
    memory = std::malloc(10);
    of_other = testing::thread_allocations() - at_start;
  });
  const long of_this = testing::thread_allocations() - before;  // std::thread's own
  other.join();
  EXPECT_EQ(of_other, 1);
  EXPECT_EQ(testing::thread_allocations() - before, of_this);
  EXPECT_GT(of_this, 0);
  std::free(memory);
}

}  // namespace
}  // namespace maploop::vehicle
