// Milliseconds a pair on the recorded drive, one thread: bin/stereo_benchmark
#include <benchmark/benchmark.h>

#include <opencv2/core.hpp>

#include "estimators/stereo/stereo_odometry.h"
#include "tests/estimators/stereo/drive_pairs.h"
#include "tests/support/real_data.h"

namespace maploop {
namespace {

void process_pair(benchmark::State& state) {
  if (testing::drive_0013().empty()) {
    state.SkipWithError(
        "the recorded drive is missing; set MAPLOOP_DATA and run tools/restore-drive");
    return;
  }
  cv::setNumThreads(1);
  const auto pairs = testing::read_pairs(sensors::KittiDrive(testing::drive_0013()));
  stereo::StereoParameters parameters;
  parameters.features_per_bucket = static_cast<int>(state.range(0));
  stereo::StereoOdometry odometry(sensors::KittiDrive(testing::drive_0013()).calibration().stereo,
                                  parameters);
  std::size_t i = 0;
  int inliers = 0;
  for (auto _ : state) {
    if (i == pairs.size()) {  // the drive begins anew: not a pair to be timed
      state.PauseTiming();
      odometry = stereo::StereoOdometry(
          sensors::KittiDrive(testing::drive_0013()).calibration().stereo, parameters);
      odometry.process(pairs[0]);
      i = 1;
      state.ResumeTiming();
    }
    inliers += odometry.process(pairs[i++]).inliers;
  }
  state.counters["inliers"] = benchmark::Counter(inliers, benchmark::Counter::kAvgIterations);
}

BENCHMARK(process_pair)
    ->ArgName("features_per_bucket")
    ->Arg(2)
    ->Arg(3)
    ->Arg(4)
    ->Iterations(288)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace maploop

BENCHMARK_MAIN();
