// This file defines a lock-free ring between one producing and one consuming thread, used in place.
//
// Producer:  if (T* slot = ring.claim()) { fill *slot; ring.publish(); }   // nullptr: full
// Consumer:  if (T* item = ring.front()) { use *item; ring.pop(); }        // nullptr: empty
//
// Who may call what. claim, publish, push: one thread at a time, the producer. front, both pop: one
// thread at a time, the consumer. size, pushed, popped, capacity: any thread. To hand either role
// to another thread, the caller must synchronize the two threads.
//
// What happens before what. Everything the producer did before publish() happens before front()
// returns that item; everything the consumer did before pop() happens before claim() hands out that
// slot again. A published item is visible to the next front() without any further call.
//
// Slots are constructed once, in memory already mapped, and reused: a claimed slot still contains
// what an earlier lap left in it. An image swaps its buffer in and out, or resizes it to its former
// size; neither allocates. No operation of the ring allocates, locks, waits or enters the kernel.
//
// This is Lamport's circular buffer ("Specifying concurrent program modules", TOPLAS 5(2), 1983)
// with each side's copy of the other's index (Lee, Bu, Chandranmenon: "MCRingBuffer", IPDPS 2010).
// As there, the consumer gives slots back in batches: a producer that waits for a full ring then
// writes a batch of lines that the consumer has left, and not the line it is reading. Publishing is
// never deferred.
#pragma once

#include <algorithm>
#include <atomic>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "runtime/core/cache_line.h"
#include "runtime/core/prefaulted_allocator.h"

namespace maploop::runtime {

template <typename T>
class Ring {
 public:
  // Makes a ring that never refuses an item while it holds fewer than `capacity`. Below
  // smallest_batched_capacity it refuses exactly at `capacity`; above, the slots of one batch are
  // added (at most an eighth, at most largest_batch - 1), and it may hold that many more. Each slot
  // starts as T(). Throws std::invalid_argument if the capacity is 0, and std::length_error or
  // std::bad_alloc if the memory is too small.
  explicit Ring(std::size_t capacity) requires std::default_initializable<T>
      : Ring(capacity, Slots(slots_for(capacity))) {}

  // Does the same; each slot starts as a copy of `prototype`, such as an image of the final size.
  Ring(std::size_t capacity, const T& prototype) requires std::copy_constructible<T>
      : Ring(capacity, Slots(slots_for(capacity), Slot{prototype})) {}

  Ring(const Ring&) = delete;
  Ring& operator=(const Ring&) = delete;

  // Producer. Returns the slot to fill, or nullptr if the ring is full. A second call without
  // publish() returns the same slot.
  T* claim() {
    if (producer_.tail == producer_.limit) {
      producer_.limit = freed_.load(std::memory_order_acquire) + slots_.size();
      if (producer_.tail == producer_.limit) return nullptr;
    }
    return &producer_.slot->value;
  }

  // Producer. Hands over the slot that claim() returned. Precondition: claim() returned one since
  // the last publish().
  void publish() {
    assert(producer_.tail != producer_.limit && "publish() without claim()");
    producer_.slot = after(producer_.slot);
    published_.store(++producer_.tail, std::memory_order_release);
  }

  // Consumer. Returns the oldest item, or nullptr if the ring is empty. A second call without pop()
  // returns the same item. The consumer may change it, or swap its buffers out.
  T* front() {
    const std::uint64_t head = consumer_.head.load(std::memory_order_relaxed);
    if (head == consumer_.seen) {
      consumer_.seen = published_.load(std::memory_order_acquire);
      if (head == consumer_.seen) return nullptr;
    }
    return &consumer_.slot->value;
  }

  // Consumer. Gives back the slot that front() returned. Precondition: front() returned one since
  // the last pop().
  void pop() {
    std::uint64_t head = consumer_.head.load(std::memory_order_relaxed);
    assert(head != consumer_.seen && "pop() without front()");
    consumer_.slot = after(consumer_.slot);
    consumer_.head.store(++head, std::memory_order_release);
    if (head == consumer_.next_free || head == consumer_.seen) {
      freed_.store(head, std::memory_order_release);
      consumer_.next_free = head + batch_;
    }
  }

  // Producer. Copies `item` in; returns false if the ring is full.
  bool push(const T& item) {
    T* slot = claim();
    if (slot == nullptr) return false;
    *slot = item;
    publish();
    return true;
  }

  // Consumer. Takes the oldest item out; returns false if the ring is empty. Swaps types with
  // buffers, so that the slot keeps the buffer that `item` had.
  bool pop(T& item) {
    T* slot = front();
    if (slot == nullptr) return false;
    if constexpr (std::is_trivially_copyable_v<T>) {
      item = *slot;
    } else {
      using std::swap;
      swap(item, *slot);
    }
    pop();
    return true;
  }

  // Returns the number of items held now, exact if neither side is active. For monitors: a producer
  // or consumer that calls it for every item slows down the other.
  std::size_t size() const {
    const std::uint64_t out = popped();  // first, so that it does not exceed the value read next
    return std::min(static_cast<std::size_t>(pushed() - out), slots_.size());
  }
  std::size_t capacity() const { return capacity_; }

  // These count the items published and taken since the start: pushed = popped + size.
  std::uint64_t pushed() const { return published_.load(std::memory_order_acquire); }
  std::uint64_t popped() const { return consumer_.head.load(std::memory_order_acquire); }

  // Rings shorter than this give each slot back at once.
  static constexpr std::size_t smallest_batched_capacity = 64;
  // This is the maximum number of slots given back together: 256 slots are 32 cache lines of 8-byte
  // items, and more brought no measurable gain.
  static constexpr std::size_t largest_batch = 256;

 private:
  // An item of a cache line or more gets lines of its own; smaller ones are packed.
  static constexpr std::size_t slot_alignment =
      std::max(alignof(T), sizeof(T) >= cache_line ? cache_line : std::size_t{1});
  struct alignas(slot_alignment) Slot {
    T value{};
  };
  using Slots = std::vector<Slot, PrefaultedAllocator<Slot>>;

  // All counts start at 0 and do not wrap in the life of any machine; slot = count modulo the
  // number of slots, kept as a pointer.
  struct alignas(no_sharing) Producer {
    std::uint64_t tail = 0;   // published so far
    std::uint64_t limit = 0;  // tail may go up to here, as far as known: slots freed + slots
    Slot* slot = nullptr;     // of tail
  };
  struct alignas(no_sharing) Consumer {
    std::atomic<std::uint64_t> head{0};  // taken so far; read by monitors, not by the producer
    std::uint64_t seen = 0;              // published, as far as known
    std::uint64_t next_free = 0;         // freed_ is stored when head reaches this
    Slot* slot = nullptr;                // of head
  };

  Ring(std::size_t capacity, Slots&& slots)
      : capacity_(capacity), batch_(batch_for(capacity)), slots_(std::move(slots)) {
    begin_ = slots_.data();
    end_ = begin_ + slots_.size();
    producer_.limit = slots_.size();
    producer_.slot = consumer_.slot = begin_;
    consumer_.next_free = batch_;
  }

  static std::size_t batch_for(std::size_t capacity) {
    return capacity < smallest_batched_capacity ? 1 : std::min(largest_batch, capacity / 8);
  }
  // Up to batch - 1 slots are free without the producer knowing it, so they are added.
  static std::size_t slots_for(std::size_t capacity) {
    if (capacity == 0) throw std::invalid_argument("ring: capacity is 0; at least 1 is needed");
    const std::size_t slots = capacity + batch_for(capacity) - 1;
    return std::max(slots, capacity);  // if the sum wrapped, the allocation fails
  }
  Slot* after(Slot* slot) const { return slot + 1 == end_ ? begin_ : slot + 1; }

  // These are constant after construction, so both sides keep a copy of their lines.
  const std::size_t capacity_;
  const std::size_t batch_;
  Slots slots_;
  Slot* begin_ = nullptr;
  Slot* end_ = nullptr;

  Producer producer_;
  Consumer consumer_;
  // The two sides communicate through these two lines.
  alignas(no_sharing) std::atomic<std::uint64_t> published_{0};
  alignas(no_sharing) std::atomic<std::uint64_t> freed_{0};
};

}  // namespace maploop::runtime
