#include "runtime/core/thread.h"

#include <pthread.h>
#include <sched.h>

#include <cstring>
#include <exception>
#include <utility>

namespace maploop::runtime {
namespace {

std::string apply(Scheduling scheduling) {
  if (scheduling.fifo_priority == 0) return "default";
  const std::string wanted = "fifo " + std::to_string(scheduling.fifo_priority);
  const sched_param parameters{scheduling.fifo_priority};
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  if (error == 0) return wanted;
  return "default (" + wanted + " refused: " + std::strerror(error) +
         "; run as root, or give the user an rtprio limit in /etc/security/limits.d)";
}

}  // namespace

Thread::Thread(std::string name, Scheduling scheduling, std::stop_token stop, Body body,
               std::function<void()> at_end)
    : name_(std::move(name)),
      thread_([this, scheduling, stop = std::move(stop), body = std::move(body),
               at_end = std::move(at_end)] {
        run(scheduling, stop, body);
        at_end();
        ended_.store(true, std::memory_order_release);
      }) {}

Thread::~Thread() { join(); }

void Thread::join() {
  if (thread_.joinable()) thread_.join();
}

void Thread::run(Scheduling scheduling, const std::stop_token& stop, const Body& body) {
  pthread_setname_np(pthread_self(), name_.substr(0, 15).c_str());
  set(scheduling_, apply(scheduling));
  try {
    body(stop);
  } catch (const std::exception& e) {
    set(failure_, e.what());
  }
}

void Thread::set(std::string& member, std::string text) {
  const std::lock_guard lock(mutex_);
  member = std::move(text);
}

std::string Thread::scheduling() const {
  const std::lock_guard lock(mutex_);
  return scheduling_;
}

std::string Thread::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

}  // namespace maploop::runtime
