// This file writes a trace as Chrome trace-event JSON; users call Tracer::write().
//
// The format is the part of "Trace Event Format" (Duffy, Sinclair; Google, 2016) that
// ui.perfetto.dev also reads. A flow's id is written as hexadecimal text, because not every
// reader's JSON numbers hold 64 bits.
#pragma once

#include <filesystem>
#include <vector>

#include "runtime/core/trace_buffer.h"

namespace maploop::runtime {

// Times count from `start`. The buffers may be recording meanwhile. Throws std::runtime_error that
// names the file.
void write_trace_json(const std::filesystem::path& file, MonotonicTime start,
                      const std::vector<const TraceBuffer*>& buffers);

}  // namespace maploop::runtime
