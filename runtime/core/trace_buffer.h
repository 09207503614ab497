// What one thread has recorded of itself, in memory mapped beforehand.
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

// Filled once from the begin to the end. When it is full, what comes then is dropped and counted:
// the start of a run explains more than an unknown part of it would. Each span, instant, counter
// value and flow mark is one event; a span takes its slot when it begins, so events are in the
// order of their times, a span before what happens in it.
//
// Who may call what. instant, counter, begin, mark: one thread, the recording one. All else: any
// thread, also meanwhile; it sees each event whole or not at all. Recording allocates nothing,
// locks nothing and makes no system call but the clock's.
//
// Tracer::thread() makes one. Code under trace calls TraceSpan, trace_instant and trace_counter.
class TraceBuffer {
 public:
  // `capacity` in events.
  TraceBuffer(std::string name, std::size_t capacity) : name_(std::move(name)), events_(capacity) {}
  TraceBuffer(const TraceBuffer&) = delete;
  TraceBuffer& operator=(const TraceBuffer&) = delete;

  // Each returns the event, or nullptr where it was dropped.
  TraceEvent* begin(TraceName name) {
    return append(TraceEvent::Kind::span, name, TraceEvent::kOpen);
  }
  TraceEvent* instant(TraceName name) { return append(TraceEvent::Kind::instant, name, 0); }
  TraceEvent* counter(TraceName name, double value) {
    return append(TraceEvent::Kind::counter, name, std::bit_cast<std::int64_t>(value));
  }
  TraceEvent* mark(TraceEvent::Kind kind, const TraceFlow& flow) {
    return append(kind, flow.source, std::bit_cast<std::int64_t>(flow.sequence));
  }
  // Counts an event that has nothing to hang on, such as the flow of a dropped span.
  void drop() {
    const std::uint64_t before = dropped_.load(std::memory_order_relaxed);
    if (before == 0) first_dropped_ = monotonic_now();
    dropped_.store(before + 1, std::memory_order_release);
  }

  const std::string& name() const { return name_; }
  std::size_t capacity() const { return events_.size(); }
  // Events recorded, the first `recorded()` of the buffer; and dropped since the start.
  std::size_t recorded() const { return recorded_.load(std::memory_order_acquire); }
  std::uint64_t dropped() const { return dropped_.load(std::memory_order_acquire); }
  // Precondition: index < recorded().
  const TraceEvent& event(std::size_t index) const { return events_[index]; }
  // When the first event was dropped. Precondition: dropped() > 0.
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
  // Written at each event: apart from the other threads' buffers.
  alignas(kNoSharing) std::atomic<std::size_t> recorded_{0};
  std::atomic<std::uint64_t> dropped_{0};
  MonotonicTime first_dropped_{};  // ordered by dropped_
};

}  // namespace maploop::runtime
