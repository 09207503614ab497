// What can be set about a process: [memory] and [trace] of the configuration.
#pragma once

#include "msgs/parameter.h"
#include "runtime/core/realtime_memory.h"
#include "runtime/core/trace.h"

namespace maploop::runtime {

ParameterTable<MemoryParameters> parameter_table(const MemoryParameters&);
ParameterTable<TraceParameters> parameter_table(const TraceParameters&);

}  // namespace maploop::runtime
