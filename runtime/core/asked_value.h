// A value that one thread asks for and another then gives once: what nobody looks at is not copied.
//
// Reader:  cell.ask();   later: if (const T* value = cell.latest()) use *value;
// Writer:  whenever it has one: cell.offer([&](T& slot) { fill slot; });
#pragma once

#include <atomic>
#include <utility>

#include "runtime/core/latest_value.h"

namespace maploop::runtime {

// One thread asks and reads, one other thread offers; what happens before what is as for
// LatestValue. Neither side ever waits, allocates or enters the kernel, but for what `fill` does.
template <typename T>
class AskedValue {
 public:
  // Reader. Asking again before an answer changes nothing.
  void ask() { asked_.store(true, std::memory_order_relaxed); }
  // Reader. As LatestValue's.
  const T* latest() { return cell_.latest(); }

  // Writer. fill(T& slot), which holds some earlier value, is called where the reader asked since
  // the last one. Whether it was.
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
