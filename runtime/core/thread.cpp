#include "runtime/core/thread.h"

#include <pthread.h>

#include <exception>
#include <utility>

namespace maploop::runtime {
namespace {

// "GRANTED", or "GRANTED (ASKED refused: WHY; REMEDY)".
std::string in_one_line(const RealtimeSetting& setting) {
  if (setting.verdict == Verdict::granted) return setting.granted;
  return setting.granted + " (" + setting.asked + " refused: " + setting.reason + "; " +
         setting.remedy + ")";
}

}  // namespace

Thread::Thread(std::string name, Scheduling scheduling, std::stop_token stop, Body body,
               std::function<void()> at_end)
    : name_(std::move(name)),
      thread_([this, scheduling = std::move(scheduling), stop = std::move(stop),
               body = std::move(body), at_end = std::move(at_end)] {
        run(scheduling, stop, body);
        at_end();
        ended_.store(true, std::memory_order_release);
      }) {}

Thread::~Thread() {
  join();
}

void Thread::join() {
  if (thread_.joinable()) thread_.join();
}

void Thread::run(const Scheduling& scheduling, const std::stop_token& stop, const Body& body) {
  pthread_setname_np(pthread_self(), name_.substr(0, 15).c_str());
  std::vector<RealtimeSetting> settings = apply_scheduling(name_, scheduling);
  {
    const std::lock_guard lock(mutex_);
    settings_ = std::move(settings);
  }
  try {
    body(stop);
  } catch (const std::exception& e) {
    const std::lock_guard lock(mutex_);
    failure_ = e.what();
  }
}

std::string Thread::scheduling() const {
  std::string text;
  for (const RealtimeSetting& setting : settings()) {
    if (setting.name == name_ + ": scheduling") text = in_one_line(setting);
    if (setting.name == name_ + ": CPUs") text += " on CPUs " + in_one_line(setting);
  }
  return text;
}

std::vector<RealtimeSetting> Thread::settings() const {
  const std::lock_guard lock(mutex_);
  return settings_;
}

std::string Thread::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

}  // namespace maploop::runtime
