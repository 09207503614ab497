// What a traced span costs: switched off, on, with a flow, with the buffer full.
//
//   build/release/bin/trace_benchmark --benchmark_repetitions=9
//       --benchmark_enable_random_interleaving=true --benchmark_report_aggregates_only=true
//
// Compare the CPU times of one run. Nothing is the empty loop; Clock is one reading of the clock,
// of which a span needs two and each mark one.
#include <benchmark/benchmark.h>

#include <memory>
#include <optional>

#include "runtime/core/trace.h"

namespace {

using maploop::runtime::trace_counter;
using maploop::runtime::trace_instant;
using maploop::runtime::TraceBuffer;
using maploop::runtime::Tracer;
using maploop::runtime::TraceSpan;

constexpr int event_count = 1 << 18;

// The compiler must not know whether tracing is on.
TraceBuffer* hidden(TraceBuffer* buffer) {
  benchmark::DoNotOptimize(buffer);
  return buffer;
}

// A buffer that is renewed, off the clock, before it is full.
class Recording {
 public:
  explicit Recording(benchmark::State& state) : state_(state) { renew(); }

  TraceBuffer* buffer(int events) {
    if (left_ < events) {
      state_.PauseTiming();
      renew();
      state_.ResumeTiming();
    }
    left_ -= events;
    return buffer_;
  }

 private:
  void renew() {
    tracer_.emplace(maploop::runtime::TraceParameters{event_count});
    buffer_ = hidden(&tracer_->thread("benchmark"));
    left_ = event_count;
  }

  benchmark::State& state_;
  std::optional<Tracer> tracer_;
  TraceBuffer* buffer_ = nullptr;
  int left_ = 0;
};

void Nothing(benchmark::State& state) {
  TraceBuffer* buffer = nullptr;
  for (auto _ : state) benchmark::DoNotOptimize(buffer);
}
BENCHMARK(Nothing);

void Clock(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(maploop::runtime::monotonic_now());
}
BENCHMARK(Clock);

void SpanOff(benchmark::State& state) {
  for (auto _ : state) TraceSpan span(hidden(nullptr), "span");
}
BENCHMARK(SpanOff);

void SpanOffWithFlow(benchmark::State& state) {
  for (auto _ : state) {
    TraceSpan span(hidden(nullptr), "span");
    span.step_flow({"camera", 1});
  }
}
BENCHMARK(SpanOffWithFlow);

void SpanOn(benchmark::State& state) {
  Recording recording(state);
  for (auto _ : state) TraceSpan span(recording.buffer(1), "span");
}
BENCHMARK(SpanOn);

void SpanOnWithFlow(benchmark::State& state) {
  Recording recording(state);
  for (auto _ : state) {
    TraceSpan span(recording.buffer(2), "span");
    span.step_flow({"camera", 1});
  }
}
BENCHMARK(SpanOnWithFlow);

void InstantOn(benchmark::State& state) {
  Recording recording(state);
  for (auto _ : state) trace_instant(recording.buffer(1), "instant");
}
BENCHMARK(InstantOn);

void CounterOn(benchmark::State& state) {
  Recording recording(state);
  for (auto _ : state) trace_counter(recording.buffer(1), "counter", 1.0);
}
BENCHMARK(CounterOn);

void SpanFull(benchmark::State& state) {
  Tracer tracer({.events_per_thread = 1});
  TraceBuffer* buffer = hidden(&tracer.thread("benchmark"));
  trace_instant(buffer, "the only one");
  for (auto _ : state) TraceSpan span(hidden(buffer), "span");
}
BENCHMARK(SpanFull);

// Of a whole buffer, to a file that keeps nothing.
void Write(benchmark::State& state) {
  Tracer tracer({.events_per_thread = event_count});
  TraceBuffer* buffer = &tracer.thread("benchmark");
  for (int i = 0; i < event_count; ++i) TraceSpan span(buffer, "span");
  for (auto _ : state) tracer.write("/dev/null");
  state.SetItemsProcessed(state.iterations() * event_count);
}
BENCHMARK(Write)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
