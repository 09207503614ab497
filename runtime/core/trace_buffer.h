// This file holds the events that one thread has recorded, in memory mapped beforehand.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "runtime/core/cache_line.h"
#include "runtime/core/data_clock.h"
#include "runtime/core/prefaulted_allocator.h"
#include "runtime/core/trace_event.h"

namespace maploop::runtime {

// The buffer is filled once from the beginning to the end. When it is full, later events are
// dropped and counted: the start of a run explains more than an unknown part of it would. Each
// span, instant, counter value and flow mark is one event; a span takes its slot when it begins, so
// events are in the order of their times, a span before the events inside it.
//
// Who may call what. instant, counter, begin, mark: one thread, the recording one. All else: any
// thread, also meanwhile; it sees each event completely or not at all. Recording does not allocate
// or lock, and makes no system call but the clock's.
//
// Tracer::thread() makes a buffer. Traced code calls TraceSpan, trace_instant and trace_counter.
class TraceBuffer {
 public:
  // `capacity` in events.
  TraceBuffer(std::string name, std::size_t capacity) : name_(std::move(name)), events_(capacity) {}
  TraceBuffer(const TraceBuffer&) = delete;
  TraceBuffer& operator=(const TraceBuffer&) = delete;

  // Each of these returns the event, or nullptr if it was dropped.
  TraceEvent* begin(TraceName name) {
    return append(TraceEvent::Kind::span, name, TraceEvent::open_payload);
  }
  TraceEvent* instant(TraceName name) { return append(TraceEvent::Kind::instant, name, 0); }
  TraceEvent* counter(TraceName name, double value) {
    return append(TraceEvent::Kind::counter, name, std::bit_cast<std::int64_t>(value));
  }
  TraceEvent* mark(TraceEvent::Kind kind, const TraceFlow& flow) {
    return append(kind, flow.source, std::bit_cast<std::int64_t>(flow.sequence));
  }
  // Counts an event that cannot be recorded, such as the flow of a dropped span.
  void drop() {
    const std::uint64_t before = dropped_.load(std::memory_order_relaxed);
    if (before == 0) first_dropped_ = monotonic_now();
    dropped_.store(before + 1, std::memory_order_release);
  }

  const std::string& name() const { return name_; }
  std::size_t capacity() const { return events_.size(); }
  // These return the number of events recorded, the first `recorded()` of the buffer, and dropped,
  // since the start.
  std::size_t recorded() const { return recorded_.load(std::memory_order_acquire); }
  std::uint64_t dropped() const { return dropped_.load(std::memory_order_acquire); }
  // Precondition: index < recorded().
  const TraceEvent& event(std::size_t index) const { return events_[index]; }
  // Returns when the first event was dropped. Precondition: dropped() > 0.
  MonotonicTime first_dropped() const { return first_dropped_; }

 private:
  TraceEvent* append(TraceEvent::Kind kind, TraceName name, std::int64_t payload) {
    const std::size_t index = recorded_.load(std::memory_order_relaxed);
    if (index == events_.size()) {
      drop();
      return nullptr;
    }
    TraceEvent& event = events_[index];
    event.name = name.text();
    event.kind = kind;
    event.payload.store(payload, std::memory_order_relaxed);
    event.time = monotonic_now();
    recorded_.store(index + 1, std::memory_order_release);
    return &event;
  }

  std::string name_;
  std::vector<TraceEvent, PrefaultedAllocator<TraceEvent>> events_;
  // These are written at each event, so they lie apart from the other threads' buffers.
  alignas(no_sharing) std::atomic<std::size_t> recorded_{0};
  std::atomic<std::uint64_t> dropped_{0};
  MonotonicTime first_dropped_{};  // ordered by dropped_
};

}  // namespace maploop::runtime
