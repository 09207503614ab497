// What the filter costs: a tick of the fusion thread, and a measurement that comes late.
//
//   build/release/bin/fusion_benchmark --benchmark_repetitions=5
//
// The filter runs a synthetic drive with a 100 Hz inertial sensor, 10 Hz odometry and wheels and
// 1 Hz GNSS, and keeps 1 s of history. Median and p99 of single calls are counters, in us.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "estimators/fusion/configuration.h"
#include "estimators/fusion/reduced_imu_filter.h"
#include "tests/estimators/fusion/synthetic_drive.h"

namespace {

using maploop::from_seconds;
using maploop::RelativeMotion;
using maploop::fusion::FusionParameters;
using maploop::fusion::ReducedImuFilter;
using maploop::testing::SyntheticDrive;

class Stopwatch {
 public:
  double microseconds() const {
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start_)
        .count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void report(benchmark::State& state, std::vector<double>& times) {
  std::sort(times.begin(), times.end());
  const auto at = [&](double share) {
    return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
  };
  state.counters["median_us"] = at(0.5);
  state.counters["p99_us"] = at(0.99);
}

// `odometry_late`: s after its stamp.
void drive_through(benchmark::State& state, double odometry_late, bool time_odometry) {
  const SyntheticDrive drive({}, 60.0, maploop::testing::test_origin());
  const auto imu = drive.imu(100.0);
  const auto odometry = drive.odometry(10.0);
  FusionParameters p;
  apply(maploop::fusion::configuration("GNSS+VO-RI"), p);
  p.history_length = p.imu_bridge = 1.0;
  std::vector<double> ticks, late;
  for (auto _ : state) {
    ReducedImuFilter filter(p, maploop::testing::test_origin());
    filter.add(drive.fix(0.0));
    std::size_t next_imu = 0, next_odometry = 0;
    for (int k = 100; k < 5900; ++k) {
      const auto now = SyntheticDrive::at(0.01 * k);
      // Odometry and fixes are timed apart from the tick, or with it.
      const auto take_late = [&] {
        while (next_odometry < odometry.size() &&
               odometry[next_odometry].stamp + from_seconds(odometry_late) <= now) {
          RelativeMotion motion = odometry[next_odometry++];
          const Stopwatch watch;
          filter.add(motion);
          late.push_back(watch.microseconds());
        }
      };
      take_late();
      const Stopwatch tick;
      while (next_imu < imu.size() && imu[next_imu].stamp <= now) filter.add(imu[next_imu++]);
      benchmark::DoNotOptimize(filter.state_at(now));
      ticks.push_back(tick.microseconds());
      if (k % 100 == 0) filter.add(drive.fix(0.01 * k));
    }
  }
  report(state, time_odometry ? late : ticks);
}

void TickWithImuSample(benchmark::State& state) {
  drive_through(state, 0.06, false);
}
void OdometryLateBy(benchmark::State& state) {
  drive_through(state, 1e-3 * static_cast<double>(state.range(0)), true);
}

BENCHMARK(TickWithImuSample)->Unit(benchmark::kMillisecond)->Iterations(3);
BENCHMARK(OdometryLateBy)->Arg(60)->Arg(200)->Unit(benchmark::kMillisecond)->Iterations(3);

}  // namespace

BENCHMARK_MAIN();
