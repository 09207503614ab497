// How late a fixed-rate thread is woken: 500 Hz, FIFO, on the schedule that the vehicle's threads
// have. To be run beside cyclictest (Debian: rt-tests) in the same minute, and under load:
//   cyclictest -q -m -p 70 -i 2000 -D 20 &
//   build/release/bin/maploop replay DRIVE --no-lcm &
//   build/release/bin/wakeup_benchmark
// Counters in microseconds. Without the right to FIFO the thread runs as any other, and says so.
#include <benchmark/benchmark.h>

#include <iostream>

#include "runtime/core/data_clock.h"
#include "runtime/core/histogram.h"
#include "runtime/core/periodic.h"
#include "runtime/core/thread.h"

namespace {

using maploop::Duration;
using maploop::MonotonicTime;
using maploop::Time;
using namespace maploop::runtime;

constexpr Duration period = std::chrono::milliseconds(2);
constexpr auto lasts = std::chrono::seconds(15);
constexpr Time start = maploop::from_nanoseconds(1'000'000'000);

void WakeUp(benchmark::State& state) {
  for (auto _ : state) {
    Histogram late;
    DataClock clock = DataClock::paced(1.0);
    clock.start(start, std::chrono::milliseconds(10));
    {
      Thread thread(
          "wakeup", Scheduling::fifo(70), {},
          [&](const std::stop_token& stop) {
            run_periodic(clock, start, {period}, stop, [&](const Tick& tick) {
              late.record(monotonic_now() - clock.due(tick.time));
              return tick.time < start + lasts;
            });
          },
          [] {});
      for (const maploop::RealtimeSetting& setting : thread.settings()) {
        if (setting.granted != setting.asked)
          std::cerr << setting.name << ": " << setting.granted << '\n';
      }
    }
    const maploop::LatencySummary summary = late.summarize("wakeup");
    const auto us = [](Duration d) { return 1e-3 * static_cast<double>(d.count()); };
    state.counters["p50"] = us(summary.p50);
    state.counters["p99"] = us(summary.p99);
    state.counters["p99.9"] = us(summary.p999);
    state.counters["max"] = us(summary.max);
  }
}
BENCHMARK(WakeUp)->Iterations(1)->Unit(benchmark::kSecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
