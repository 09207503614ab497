#include "runtime/vehicle/faults/fault_hog.h"

#include <chrono>
#include <utility>

#include "runtime/core/data_clock.h"

namespace maploop::vehicle {
namespace {

constexpr auto look_every = std::chrono::milliseconds(5);

// This takes about a tenth of a millisecond of one core.
void compute_nothing() {
  constexpr int steps = 100'000;
  for (int i = 0; i < steps; ++i) std::atomic_signal_fence(std::memory_order_seq_cst);
}

}  // namespace

CpuHog::CpuHog(int threads, FaultWindow window, std::function<Time()> position,
               std::atomic<std::uint64_t>& struck)
    : position_(std::move(position)) {
  for (int i = 0; i < threads; ++i) {
    threads_.emplace_back([this, window, &struck] { run(window, struck); });
  }
}

CpuHog::~CpuHog() {
  stop_.request_stop();
  for (std::thread& thread : threads_) thread.join();
}

void CpuHog::run(FaultWindow window, std::atomic<std::uint64_t>& struck) const {
  while (position_() < window.begin) {
    if (stop_.stop_requested()) return;
    std::this_thread::sleep_for(look_every);
  }
  const MonotonicTime last = runtime::monotonic_now() + longest_hog;
  struck.fetch_add(1, std::memory_order_relaxed);
  while (position_() < window.end && !stop_.stop_requested() && runtime::monotonic_now() < last) {
    compute_nothing();
  }
}

}  // namespace maploop::vehicle
