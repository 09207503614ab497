// This file traces a run: what each thread did when, and which sample became part of which state.
//
//   Tracer tracer({});
//   TraceBuffer* buffer = &tracer.thread("stereo");   // nullptr if tracing is off
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
  int events_per_thread = 1 << 18;
};

// Owns the buffers; must outlive every thread that records. Any thread may call any member at any
// time.
class Tracer {
 public:
  // Throws std::invalid_argument if a parameter is out of its range.
  explicit Tracer(const TraceParameters& parameters);

  // Makes a buffer for one thread; only this step allocates. Two threads may have the same name.
  TraceBuffer& thread(std::string name);

  // Makes a name at run time, kept as long as the tracer. Precondition: it does not contain '\0'.
  TraceName name(std::string_view text);

  // These are sums over all threads since the start.
  std::uint64_t recorded() const;
  std::uint64_t dropped() const;

  // Writes everything recorded so far as Chrome trace-event JSON and replaces the file; recording
  // continues, and a later call writes everything again. Times are in microseconds with nanosecond
  // decimals since the tracer was made; the tracer's start time and the counts of events recorded
  // and dropped by each thread are in "otherData". A span that has not ended lasts until now and
  // has "unfinished" in its "args". Takes 64 kB of memory whatever the size. Throws
  // std::runtime_error that names the file.
  void write(const std::filesystem::path& file) const;

 private:
  std::size_t events_per_thread_;
  MonotonicTime start_;
  mutable std::mutex mutex_;  // protects the two containers
  std::vector<std::unique_ptr<TraceBuffer>> buffers_;
  std::set<std::string, std::less<>> names_;
};

}  // namespace maploop::runtime
