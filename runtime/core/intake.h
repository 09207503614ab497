// This file takes samples from a thread's edges in an order that depends only on the data's times,
// not on which thread ran first.
#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/core/edge.h"

namespace maploop::runtime {

// Samples are taken in the order (available, edge as added, order of sending). An intake belongs to
// the consuming thread and is not shared.
class Intake {
 public:
  // `handle` receives each sample of the edge and may change it (swap its buffers out).
  template <class T, class Handle>
  void add(Edge<T>& edge, Handle handle) {
    inlets_.push_back({&edge, [&edge, handle = std::move(handle)] {
                         handle(*edge.front());
                         edge.pop();
                       }});
  }

  // Adds an edge from a thread that ends after this one: finished() does not wait for its end.
  template <class T, class Handle>
  void add_feedback(Edge<T>& edge, Handle handle) {
    add(edge, std::move(handle));
    inlets_.back().feedback = true;
  }

  // Returns the `available` up to which all edges promise that everything has been sent.
  Time promised() const {
    Time t = Time::max();
    for (const Inlet& inlet : inlets_) t = std::min(t, inlet.edge->promised());
    return t;
  }

  // Waits until promised() >= t, and meanwhile takes what is already promised: a producer with more
  // samples before t than its ring can hold needs room before it can promise t. `bell` is the bell
  // of the edges. Returns false if stopped before.
  bool wait(Time t, const Doorbell& bell, const std::stop_token& stop) {
    for (;;) {
      const std::uint32_t heard = bell.listen();
      const Time known = promised();
      if (known >= t) return true;
      if (stop.stop_requested()) return false;
      waited_for_ = slowest();
      take_until(known);
      bell.wait(heard);
    }
  }

  // Takes every sample in the rings with available <= t; these are all of them if promised() >= t.
  void take_until(Time t) {
    for (;;) {
      Inlet* next = nullptr;
      Time earliest = Time::max();
      for (Inlet& inlet : inlets_) {
        const Sample* head = inlet.edge->head();
        if (head != nullptr && head->available <= t &&
            (next == nullptr || head->available < earliest)) {
          next = &inlet;
          earliest = head->available;
        }
      }
      if (next == nullptr) return;
      next->take();
      ++taken_;
    }
  }

  // Names the edge that wait() last waited for, as EdgeBase::waiting() does.
  const char* waiting() const {
    return waited_for_ != nullptr ? waited_for_->waiting() : "waiting for input";
  }

  // Returns the number of samples taken so far.
  std::uint64_t taken() const { return taken_; }

  // Returns whether the rings are empty and nothing more comes.
  bool finished() const {
    for (const Inlet& inlet : inlets_) {
      if (inlet.feedback) continue;
      if (inlet.edge->promised() != Time::max() || inlet.edge->head() != nullptr) return false;
    }
    return true;
  }

  // Marks the end of this thread, which takes nothing more: see EdgeBase::abandon().
  void abandon() {
    for (const Inlet& inlet : inlets_) inlet.edge->abandon();
  }

 private:
  struct Inlet {
    EdgeBase* edge;
    std::function<void()> take;
    bool feedback = false;
  };

  const EdgeBase* slowest() const {
    const EdgeBase* slowest = nullptr;
    for (const Inlet& inlet : inlets_) {
      if (slowest == nullptr || inlet.edge->promised() < slowest->promised()) slowest = inlet.edge;
    }
    return slowest;
  }

  std::vector<Inlet> inlets_;
  const EdgeBase* waited_for_ = nullptr;
  std::uint64_t taken_ = 0;
};

}  // namespace maploop::runtime
