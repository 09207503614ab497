// This file passes a value from one thread to another on request: values that nobody requests are
// not copied.
//
// Reader:  cell.ask();   later: if (const T* value = cell.latest()) use *value;
// Writer:  whenever it has one: cell.offer([&](T& slot) { fill slot; });
#pragma once

#include <atomic>
#include <utility>

#include "runtime/core/latest_value.h"

namespace maploop::runtime {

// One thread asks and reads, one other thread offers; the ordering is that of LatestValue. Neither
// side ever waits, allocates or enters the kernel, except in `fill`.
template <typename T>
class AskedValue {
 public:
  // Reader. Requests a value; a second request before the answer has no effect.
  void ask() { asked_.store(true, std::memory_order_relaxed); }
  // Reader. Works like LatestValue::latest().
  const T* latest() { return cell_.latest(); }

  // Writer. If the reader has asked since the last value, calls fill(T& slot), whose slot contains
  // some earlier value. Returns whether it was called.
  template <class Fill>
  bool offer(Fill&& fill) {
    if (!asked_.load(std::memory_order_relaxed)) return false;
    asked_.store(false, std::memory_order_relaxed);
    std::forward<Fill>(fill)(cell_.back());
    cell_.publish();
    return true;
  }

 private:
  LatestValue<T> cell_;
  std::atomic<bool> asked_{false};
};

}  // namespace maploop::runtime
