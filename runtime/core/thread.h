// This file defines a named thread with requested scheduling, and records what the kernel granted.
#pragma once

#include <atomic>
#include <ctime>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "msgs/time.h"
#include "runtime/core/realtime_scheduling.h"

namespace maploop::runtime {

// Runs `body(stop)` on its own thread. An exception that leaves the body ends this thread only: its
// text is kept in failure(), and `at_end` is called as after a normal end.
class Thread {
 public:
  using Body = std::function<void(const std::stop_token&)>;

  // `name` is shown by ps and top, cut to 15 characters.
  Thread(std::string name, Scheduling scheduling, std::stop_token stop, Body body,
         std::function<void()> at_end);
  ~Thread();  // joins
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;

  void join();
  const std::string& name() const { return name_; }
  // Returns all requests for this thread, "NAME: scheduling" first. Available from construction on.
  const std::vector<RealtimeSetting>& settings() const { return settings_; }
  std::string failure() const;  // empty if there was none
  // Returns the processor time used so far; any thread may call it, also after this thread's end.
  Duration cpu_time() const;
  bool ended() const { return ended_.load(std::memory_order_acquire); }

 private:
  static constexpr clockid_t no_clock = -1;

  void run(const std::stop_token& stop, const Body& body);

  std::string name_;
  std::vector<RealtimeSetting> settings_;
  mutable std::mutex mutex_;  // protects failure_
  std::string failure_;
  std::atomic<clockid_t> cpu_clock_{no_clock};
  std::atomic<Duration::rep> cpu_at_end_{0};
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

// Returns the processor time that the calling thread has used so far. It enters the kernel.
Duration this_thread_cpu_time();

}  // namespace maploop::runtime
