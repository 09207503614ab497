// This file defines a cell between one writing and one reading thread in which the newest value
// wins, used in place.
//
// Writer:  fill cell.back(); cell.publish();
// Reader:  if (const T* value = cell.latest()) use *value;   // nullptr: nothing new
//
// Who may call what. back, publish: one thread at a time, the writer. latest: one thread at a time,
// the reader.
//
// What happens before what. Everything the writer did before publish() happens before latest()
// returns that value; everything the reader did before latest() happens before the writer gets the
// buffer it left. A published value is visible to the next latest() without any further call.
//
// It is a triple buffer: the writer fills one buffer, the reader holds one, and the third is
// exchanged by one atomic operation. Neither side ever waits, allocates, locks or enters the
// kernel.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "runtime/core/cache_line.h"

namespace maploop::runtime {

template <typename T>
class LatestValue {
 public:
  LatestValue() = default;  // each of the three buffers starts as T()
  LatestValue(const LatestValue&) = delete;
  LatestValue& operator=(const LatestValue&) = delete;

  // Writer. Returns the buffer to fill, with some earlier value; it is the same one until
  // publish().
  T& back() { return buffers_[back_.index].value; }

  // Writer. Makes back() the newest value; an unread older value is lost.
  void publish() {
    back_.index =
        waiting_.exchange(back_.index | unread_bit, std::memory_order_acq_rel) & index_bits;
  }

  // Reader. Returns the newest value if one was published since the last call, otherwise nullptr.
  // It stays valid and unchanged until latest() returns another one.
  const T* latest() {
    if ((waiting_.load(std::memory_order_relaxed) & unread_bit) == 0) return nullptr;
    front_.index = waiting_.exchange(front_.index, std::memory_order_acq_rel) & index_bits;
    return &buffers_[front_.index].value;
  }

 private:
  static constexpr std::uint32_t index_bits = 3;  // index of the buffer in between
  static constexpr std::uint32_t unread_bit = 4;  // set if it has not been read

  struct alignas(no_sharing) Buffer {
    T value{};
  };
  struct alignas(no_sharing) Side {
    std::uint32_t index;
  };

  std::array<Buffer, 3> buffers_;
  Side back_{0};   // the writer's
  Side front_{2};  // the reader's
  alignas(no_sharing) std::atomic<std::uint32_t> waiting_{1};
};

}  // namespace maploop::runtime
