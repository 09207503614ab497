#include "runtime/core/thread.h"

#include <pthread.h>

#include <exception>
#include <future>
#include <optional>
#include <utility>

namespace maploop::runtime {
namespace {

// Returns nothing if the clock's thread has ended.
std::optional<Duration> read(clockid_t clock) {
  timespec t{};
  if (clock_gettime(clock, &t) != 0) return {};
  return std::chrono::seconds(t.tv_sec) + Duration(t.tv_nsec);
}

}  // namespace

Thread::Thread(std::string name, Scheduling scheduling, std::stop_token stop, Body body,
               std::function<void()> at_end)
    : name_(std::move(name)) {
  std::promise<std::vector<RealtimeSetting>> asked;
  std::future<std::vector<RealtimeSetting>> answer = asked.get_future();
  thread_ = std::thread([this, scheduling = std::move(scheduling), stop = std::move(stop),
                         body = std::move(body), at_end = std::move(at_end),
                         asked = std::move(asked)]() mutable {
    clockid_t cpu_clock = no_clock;
    if (pthread_getcpuclockid(pthread_self(), &cpu_clock) == 0) {
      cpu_clock_.store(cpu_clock, std::memory_order_release);
    }
    pthread_setname_np(pthread_self(), name_.substr(0, 15).c_str());
    asked.set_value(apply_scheduling(name_, scheduling));
    run(stop, body);
    at_end();
    cpu_at_end_.store(this_thread_cpu_time().count(), std::memory_order_relaxed);
    cpu_clock_.store(no_clock, std::memory_order_release);
    ended_.store(true, std::memory_order_release);
  });
  settings_ = answer.get();
}

Thread::~Thread() {
  join();
}

void Thread::join() {
  if (thread_.joinable()) thread_.join();
}

void Thread::run(const std::stop_token& stop, const Body& body) {
  try {
    body(stop);
  } catch (const std::exception& e) {
    const std::lock_guard lock(mutex_);
    failure_ = e.what();
  }
}

std::string Thread::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

// The clock is read by its number, which outlives the thread, and not by the thread's handle. If
// the thread ended in between, cpu_at_end_ has its final value.
Duration Thread::cpu_time() const {
  const clockid_t clock = cpu_clock_.load(std::memory_order_acquire);
  if (clock != no_clock) {
    if (const std::optional<Duration> used = read(clock)) return *used;
  }
  return Duration(cpu_at_end_.load(std::memory_order_relaxed));
}

Duration this_thread_cpu_time() {
  return read(CLOCK_THREAD_CPUTIME_ID).value_or(Duration{});
}

}  // namespace maploop::runtime
