// This file wakes one sleeping consumer when something has changed for it.
#pragma once

#include <atomic>
#include <cstdint>

namespace maploop::runtime {

// Consumer: heard = listen(); check whether there is work; if not, wait(heard). A ring() after
// listen() makes that wait() return at once, so no change is missed; all writes before ring() are
// visible after the wait() or listen() that heard it. Any thread may ring; ringing costs a system
// call only while the consumer sleeps.
class Doorbell {
 public:
  void ring() {
    count_.fetch_add(1, std::memory_order_release);
    count_.notify_one();
  }
  std::uint32_t listen() const { return count_.load(std::memory_order_acquire); }
  void wait(std::uint32_t heard) const { count_.wait(heard, std::memory_order_acquire); }

 private:
  std::atomic<std::uint32_t> count_{0};
};

}  // namespace maploop::runtime
