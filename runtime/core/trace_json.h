// A trace as Chrome trace-event JSON; users call Tracer::write().
//
// Format: "Trace Event Format" (Duffy, Sinclair; Google, 2016), the part that ui.perfetto.dev reads
// too. A flow's id is written as hexadecimal text: a JSON number does not hold 64 bits everywhere.
#pragma once

#include <filesystem>
#include <vector>

#include "runtime/core/trace_buffer.h"

namespace maploop::runtime {

// Times count from `start`. The buffers may be recording meanwhile. Throws std::runtime_error
// naming the file.
void write_trace_json(const std::filesystem::path& file, MonotonicTime start,
                      const std::vector<const TraceBuffer*>& buffers);

}  // namespace maploop::runtime
