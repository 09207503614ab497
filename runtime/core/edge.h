// This file defines one edge of the graph: a ring from one producing to one consuming thread, with
// the producer's promise about the samples to come.
#pragma once

#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "msgs/diagnostics.h"
#include "msgs/sample.h"
#include "runtime/core/doorbell.h"
#include "runtime/core/ring.h"

namespace maploop::runtime {

enum class Overflow {
  keep_all,     // the producer waits for room while there is a reader: replay only, see
                // EdgeBase::drop_when_full()
  drop_newest,  // the new sample is dropped and counted
};

// This is the interface of a consumer to an edge of any sample type.
class EdgeBase {
 public:
  virtual ~EdgeBase() = default;

  // Everything that the producer will ever send with available <= promised() is in the ring or has
  // been taken, if the promise is read before the ring. Time::max() means that nothing more comes.
  Time promised() const { return from_nanoseconds(promised_.load(std::memory_order_acquire)); }

  // Producer. Promises only increase; a smaller one has no effect.
  void promise(Time t) {
    if (to_nanoseconds(t) <= promised_.load(std::memory_order_relaxed)) return;
    promised_.store(to_nanoseconds(t), std::memory_order_release);
    if (bell_ != nullptr) bell_->ring();
  }
  void finish() { promise(Time::max()); }

  // Switches to Overflow::drop_newest; call it before the threads run.
  virtual void drop_when_full() = 0;

  // Consumer. Returns the oldest sample, or nullptr.
  virtual const Sample* head() = 0;

  // Consumer. Marks the end of the consumer, which takes nothing more. From then on the producer
  // never waits for room; samples that do not fit are lost and counted.
  void abandon() { abandoned_.store(true, std::memory_order_release); }
  bool abandoned() const { return abandoned_.load(std::memory_order_acquire); }

  virtual RingHealth health() const = 0;

  // Returns "waiting for imu -> fusion": the state of a consumer that this edge delays.
  const char* waiting() const { return waiting_.c_str(); }

 protected:
  EdgeBase(const std::string& name, Doorbell* bell)
      : bell_(bell), waiting_("waiting for " + name) {}
  Doorbell* bell_;

 private:
  std::string waiting_;
  std::atomic<std::int64_t> promised_{to_nanoseconds(Time::min())};
  std::atomic<bool> abandoned_{false};
};

// `available` of the samples must not decrease. One thread calls push(), promise() and finish(),
// one other thread calls head(), front(), pop() and abandon(); any thread may call health(). If a
// `bell` is given, it is rung for the consumer at each push and each new promise.
template <std::derived_from<Sample> T>
class Edge final : public EdgeBase {
 public:
  Edge(std::string name, std::size_t capacity, Overflow overflow, Doorbell* bell,
       const T& prototype = T{})
      : EdgeBase(name, bell),
        name_(std::move(name)),
        overflow_(overflow),
        ring_(capacity, prototype) {}

  // fill(T& slot) writes the sample in place. Returns false if the sample was lost: the ring was
  // full and the policy is to drop, the consumer has abandoned the edge, or `stop` was requested
  // while waiting for room.
  template <class Fill>
  bool push(const std::stop_token& stop, Fill&& fill) {
    pushed_.fetch_add(1, std::memory_order_relaxed);
    T* slot = ring_.claim();
    while (slot == nullptr && overflow_ == Overflow::keep_all && !abandoned() &&
           !stop.stop_requested()) {
      std::this_thread::sleep_for(back_pressure_poll);
      slot = ring_.claim();
    }
    if (slot == nullptr) {
      lost_.fetch_add(1, std::memory_order_release);
      return false;
    }
    fill(*slot);
    ring_.publish();
    if (bell_ != nullptr) bell_->ring();
    return true;
  }

  bool push(const T& sample, const std::stop_token& stop) {
    return push(stop, [&](T& slot) { slot = sample; });
  }

  void drop_when_full() override { overflow_ = Overflow::drop_newest; }

  T* front() { return ring_.front(); }
  const Sample* head() override { return ring_.front(); }
  void pop() {
    ring_.pop();
    popped_.fetch_add(1, std::memory_order_relaxed);
  }

  std::size_t held() const { return ring_.size(); }

  // pushed = popped + lost + held, if neither thread is using the edge.
  RingHealth health() const override {
    RingHealth h;
    h.name = name_;
    h.popped = popped_.load(std::memory_order_relaxed);
    h.lost = lost_.load(std::memory_order_acquire);
    h.held = held();
    h.pushed = pushed_.load(std::memory_order_relaxed);
    h.capacity = ring_.capacity();
    return h;
  }

 private:
  static constexpr auto back_pressure_poll = std::chrono::microseconds(50);

  std::string name_;
  Overflow overflow_;
  Ring<T> ring_;
  std::atomic<std::uint64_t> pushed_{0};
  std::atomic<std::uint64_t> popped_{0};
  std::atomic<std::uint64_t> lost_{0};
};

}  // namespace maploop::runtime
