#include "runtime/core/thread.h"

#include <pthread.h>

#include <exception>
#include <future>
#include <utility>

namespace maploop::runtime {

Thread::Thread(std::string name, Scheduling scheduling, std::stop_token stop, Body body,
               std::function<void()> at_end)
    : name_(std::move(name)) {
  std::promise<std::vector<RealtimeSetting>> asked;
  std::future<std::vector<RealtimeSetting>> answer = asked.get_future();
  thread_ = std::thread([this, scheduling = std::move(scheduling), stop = std::move(stop),
                         body = std::move(body), at_end = std::move(at_end),
                         asked = std::move(asked)]() mutable {
    pthread_setname_np(pthread_self(), name_.substr(0, 15).c_str());
    asked.set_value(apply_scheduling(name_, scheduling));
    run(stop, body);
    at_end();
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

}  // namespace maploop::runtime
