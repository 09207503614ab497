// Tracing of a run: what each thread did when, and which sample became part of which state.
//
//   Tracer tracer({});
//   TraceBuffer* buffer = &tracer.thread("stereo");   // nullptr: tracing is off
//   { TraceSpan span(buffer, "stereo"); span.step_flow({"camera", pair.sequence}); ... }
//   tracer.write("drive.json");                       // for ui.perfetto.dev or chrome://tracing
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/core/trace_span.h"

namespace maploop::runtime {

struct TraceParameters {
  // Of each thread, 32 bytes each. The default takes 8 MiB a thread and holds 8 minutes of a 100 Hz
  // thread that records 5 events a tick.
  int events_per_thread = 1 << 18;
};

// Owns the buffers; must outlive every thread that records. All members may be called by any thread
// at any time.
class Tracer {
 public:
  // Throws std::invalid_argument where events_per_thread is below 1.
  explicit Tracer(const TraceParameters& parameters);

  // A new buffer, for one thread: the only step that allocates. Two threads may have the same name.
  TraceBuffer& thread(std::string name);

  // A name made at run time, kept as long as the tracer. Precondition: no '\0' in it.
  TraceName name(std::string_view text);

  // Of all threads since the start.
  std::uint64_t recorded() const;
  std::uint64_t dropped() const;

  // Writes all that was recorded up to now as Chrome trace-event JSON, over what the file held;
  // recording goes on, and a later call writes everything again. Times are in microseconds with
  // nanosecond decimals since the tracer was made; its own time and what each thread recorded and
  // dropped are in "otherData". A span that has not ended lasts to now and has "unfinished" in its
  // "args". Takes 64 kB of memory whatever the size. Throws std::runtime_error naming the file.
  void write(const std::filesystem::path& file) const;

 private:
  std::size_t events_per_thread_;
  MonotonicTime start_;
  mutable std::mutex mutex_;  // of the two containers
  std::vector<std::unique_ptr<TraceBuffer>> buffers_;
  std::set<std::string, std::less<>> names_;
};

}  // namespace maploop::runtime
