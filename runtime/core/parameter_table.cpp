#include "runtime/core/parameter_table.h"

namespace maploop::runtime {

ParameterTable<MemoryParameters> parameter_table(const MemoryParameters&) {
  using enum Audience;
  using P = MemoryParameters;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"lock_memory", &P::lock_memory, usual,
       "Whether pages are locked in memory. A page that has to come back from the disk costs "
       "milliseconds."},
      {"heap_mb", &P::heap_mb, 0, 1 << 20, "MiB", usual,
       "Heap that is mapped at the start and kept when it is freed: the buffers that are allocated "
       "while the first images and scans come in. 0: none."},
      {"malloc_arenas", &P::malloc_arenas, 1, 1024, "arenas", expert,
       "Arenas of malloc. With one, every thread uses the heap that is mapped at the start."},
  });
  return {"memory", "Memory of a process that runs in real time.", table};
}

ParameterTable<TraceParameters> parameter_table(const TraceParameters&) {
  using enum Audience;
  using P = TraceParameters;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"events_per_thread", &P::events_per_thread, 1, 1 << 30, "events", expert,
       "Events that the trace of a thread holds, 32 bytes each. The default takes 8 MiB and holds "
       "8 minutes of a 100 Hz thread that records 5 events per tick."},
  });
  return {"trace", "Traces of what the threads did (--trace).", table};
}

}  // namespace maploop::runtime
