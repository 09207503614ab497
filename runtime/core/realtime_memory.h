// Memory that is there before it is needed: no page fault in the middle of a tick.
#pragma once

#include <string>
#include <vector>

#include "runtime/core/realtime_privileges.h"
#include "runtime/core/realtime_setting.h"

namespace maploop::runtime {

struct MemoryParameters {
  // Pages stay in memory: one that has to come back from the disk costs milliseconds.
  bool lock_memory = true;
  // Mapped beforehand, and kept when freed: what buffers allocate while the first images and scans
  // come in. A page fault costs a microsecond, and 64 MiB have 16384.
  int heap_mb = 64;
  // Of malloc: threads beyond share them. One, so that every thread draws on the heap that was
  // mapped beforehand; real-time threads allocate nothing after their start.
  int malloc_arenas = 1;
};

// Of the process, once, before it starts threads: "heap", then "locked memory". Never throws for
// what the kernel says.
//
// Future memory is locked as it is touched, so a thread's stack of 8 MiB takes no more than it
// uses. Where RLIMIT_MEMLOCK is finite and CAP_IPC_LOCK missing, future memory is not locked at
// all: an allocation beyond the limit would fail.
std::vector<RealtimeSetting> prepare_memory(const MemoryParameters& parameters,
                                            const Privileges& privileges);

// Maps `kb` of the calling thread's stack below where it stands: "NAME: stack".
RealtimeSetting prefault_stack(const std::string& name, int kb);

}  // namespace maploop::runtime
