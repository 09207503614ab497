// Making a process ready for real time, and saying how ready it is.
//
//   RealtimeReport report = prepare_process({});   // first thing in main, before other threads
//   Thread fusion("fusion", Scheduling::fifo(60), stop, body, at_end);
//   append(report, fusion.settings());             // once it has started
//   std::cout << to_text(report);
//
// Nothing here is fatal: what the kernel refuses is reported with the reason and the remedy, and
// the program runs on as well as the machine lets it.
#pragma once

#include <vector>

#include "runtime/core/realtime_machine.h"
#include "runtime/core/realtime_memory.h"
#include "runtime/core/realtime_scheduling.h"
#include "runtime/core/realtime_setting.h"

namespace maploop::runtime {

// Prepares the memory, then looks at the process's limits and at the machine. Call once.
RealtimeReport prepare_process(const MemoryParameters& memory);

void append(RealtimeReport& report, const std::vector<RealtimeSetting>& settings);

}  // namespace maploop::runtime
