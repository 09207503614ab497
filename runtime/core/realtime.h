// This file prepares a process for real time, and reports how well it is prepared.
//
//   RealtimeReport report = prepare_process({});   // first thing in main, before other threads
//   Thread fusion("fusion", Scheduling::fifo(60), stop, body, at_end);
//   append(report, fusion.settings());             // once it has started
//   std::cout << to_text(report);
//
// No error here is fatal: a refusal of the kernel is reported with its reason and remedy, and the
// program continues as well as the machine allows.
#pragma once

#include <vector>

#include "runtime/core/realtime_machine.h"
#include "runtime/core/realtime_memory.h"
#include "runtime/core/realtime_scheduling.h"
#include "runtime/core/realtime_setting.h"

namespace maploop::runtime {

// Prepares the memory, then checks the process's limits and the machine. Call it once.
RealtimeReport prepare_process(const MemoryParameters& memory);

void append(RealtimeReport& report, const std::vector<RealtimeSetting>& settings);

}  // namespace maploop::runtime
