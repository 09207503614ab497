// This file maps memory before it is needed, so that no page fault occurs during a tick.
#pragma once

#include <string>
#include <vector>

#include "runtime/core/realtime_privileges.h"
#include "runtime/core/realtime_setting.h"

namespace maploop::runtime {

struct MemoryParameters {
  // Keeps pages in memory: reading one back from the disk costs milliseconds.
  bool lock_memory = true;
  // Mapped beforehand, and kept when freed: the memory that buffers allocate while the first images
  // and scans arrive. A page fault costs a microsecond, and 64 MiB have 16384 of them.
  int heap_mb = 64;
  // Maximum number of malloc's arenas, which threads share. It is one, so that every thread uses
  // the heap that was mapped beforehand; real-time threads allocate nothing after their start.
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
