// This file defines a cell between one writing and one reading thread in which the newest value
// wins, used in place.
//
// Writer:  fill cell.back(); cell.publish();
// Reader:  if (const T* value = cell.latest()) use *value;   // nullptr: nothing new
//
// Who may call what. back, publish: one thread at a time, the writer. latest: one thread at a time,
// the reader. The counters: any thread.
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
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "runtime/core/cache_line.h"

namespace maploop::runtime {

template <typename T>
class LatestValue {
 public:
  // Each of the three buffers starts as T().
  LatestValue() requires std::default_initializable<T>
  = default;

  // Each of the three buffers starts as a copy of `prototype`, such as an image of the final size.
  explicit LatestValue(const T& prototype) requires std::copy_constructible<T>
      : buffers_{Buffer{prototype}, Buffer{prototype}, Buffer{prototype}} {}

  LatestValue(const LatestValue&) = delete;
  LatestValue& operator=(const LatestValue&) = delete;

  // Writer. Returns the buffer to fill, with some earlier value; it is the same one until
  // publish().
  T& back() { return buffers_[writer_.back].value; }

  // Writer. Makes back() the newest value; an unread older value is overwritten and counted.
  void publish() {
    add_one(writer_.published);
    const std::uint32_t waiting =
        waiting_.exchange(writer_.back | kUnread, std::memory_order_acq_rel);
    if ((waiting & kUnread) != 0) add_one(writer_.overwritten);
    writer_.back = waiting & kIndex;
  }

  // Reader. Returns the newest value if one was published since the last call, otherwise nullptr.
  // It stays valid and unchanged until latest() returns another one.
  const T* latest() {
    if ((waiting_.load(std::memory_order_relaxed) & kUnread) == 0) return nullptr;
    reader_.front = waiting_.exchange(reader_.front, std::memory_order_acq_rel) & kIndex;
    add_one(reader_.taken);
    return &buffers_[reader_.front].value;
  }

  // Counts since the start, exact if neither side is active: published = taken + overwritten, plus
  // one if a value is unread.
  std::uint64_t published() const { return writer_.published.load(std::memory_order_relaxed); }
  std::uint64_t overwritten() const { return writer_.overwritten.load(std::memory_order_relaxed); }
  std::uint64_t taken() const { return reader_.taken.load(std::memory_order_relaxed); }

 private:
  static constexpr std::uint32_t kIndex = 3;   // index of the buffer in between
  static constexpr std::uint32_t kUnread = 4;  // set if it has not been read

  struct alignas(kNoSharing) Buffer {
    T value{};
  };
  struct alignas(kNoSharing) Writer {
    std::uint32_t back = 0;
    std::atomic<std::uint64_t> published{0};
    std::atomic<std::uint64_t> overwritten{0};
  };
  struct alignas(kNoSharing) Reader {
    std::uint32_t front = 2;
    std::atomic<std::uint64_t> taken{0};
  };

  // Only one thread writes each counter, so no locked instruction is needed.
  static void add_one(std::atomic<std::uint64_t>& counter) {
    counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }

  std::array<Buffer, 3> buffers_;
  Writer writer_;
  Reader reader_;
  alignas(kNoSharing) std::atomic<std::uint32_t> waiting_{1};
};

}  // namespace maploop::runtime
