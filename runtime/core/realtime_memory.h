// This file maps memory before it is needed, so that no page fault occurs during a tick.
#pragma once

#include <string>
#include <vector>

#include "runtime/core/realtime_privileges.h"
#include "runtime/core/realtime_setting.h"

namespace maploop::runtime {

struct MemoryParameters {
  bool lock_memory = true;
  int heap_mb = 64;
  int malloc_arenas = 1;
};

// Prepares the process, once, before it starts threads, and returns "heap", then "locked memory".
// Never throws if the kernel refuses.
//
// Future memory is locked when it is touched, so a thread's stack of 8 MiB takes no more than it
// uses. If RLIMIT_MEMLOCK is finite and CAP_IPC_LOCK missing, future memory is not locked at all:
// an allocation beyond the limit would fail.
std::vector<RealtimeSetting> prepare_memory(const MemoryParameters& parameters,
                                            const Privileges& privileges);

// Maps `kb` kB of the calling thread's stack below its current position; returns "NAME: stack".
RealtimeSetting prefault_stack(const std::string& name, int kb);

}  // namespace maploop::runtime
