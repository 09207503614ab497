// This file contains the calls of traced code. Every function takes a TraceBuffer*, which is
// nullptr if tracing is off: the call then costs a branch.
#pragma once

#include "runtime/core/trace_buffer.h"

namespace maploop::runtime {

// Records the time from construction to destruction on the recording thread. Spans of one thread
// nest.
//
//   TraceSpan span(buffer, "stereo");
//   span.step_flow({"camera", pair.sequence});
class TraceSpan {
 public:
  TraceSpan(TraceBuffer* buffer, TraceName name)
      : buffer_(buffer), event_(buffer == nullptr ? nullptr : buffer->begin(name)) {}
  ~TraceSpan() {
    if (event_ == nullptr) return;
    const Duration duration = monotonic_now() - event_->time;
    event_->payload.store(duration.count(), std::memory_order_release);
  }
  TraceSpan(const TraceSpan&) = delete;
  TraceSpan& operator=(const TraceSpan&) = delete;

  // These draw an arrow from this span to the next one that the flow passes. The viewers tie a mark
  // to the innermost span open at that moment, so call them before a span inside this one begins.
  // Arrows point forward if the mark precedes handing the sample on, and follows taking it. A flow
  // starts once and ends once.
  void start_flow(const TraceFlow& flow) { mark(TraceEvent::Kind::flow_start, flow); }
  void step_flow(const TraceFlow& flow) { mark(TraceEvent::Kind::flow_step, flow); }
  void end_flow(const TraceFlow& flow) { mark(TraceEvent::Kind::flow_end, flow); }

 private:
  void mark(TraceEvent::Kind kind, const TraceFlow& flow) {
    if (buffer_ == nullptr) return;
    if (event_ == nullptr) {
      buffer_->drop();
    } else {
      buffer_->mark(kind, flow);
    }
  }

  TraceBuffer* buffer_;
  TraceEvent* event_;  // nullptr if tracing is off, or the span was dropped
};

// Records a moment, such as a missed deadline.
inline void trace_instant(TraceBuffer* buffer, TraceName name) {
  if (buffer != nullptr) buffer->instant(name);
}

// Records a value over time, such as the samples held by a ring. Each name has one track, whichever
// thread records.
inline void trace_counter(TraceBuffer* buffer, TraceName name, double value) {
  if (buffer != nullptr) buffer->counter(name, value);
}

}  // namespace maploop::runtime
