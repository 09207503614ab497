// This file reads what the kernel allows this process to request.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace maploop::runtime {

struct Privileges {
  static constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();

  bool sys_nice = false;                   // CAP_SYS_NICE: any policy, priority, nice value
  bool ipc_lock = false;                   // CAP_IPC_LOCK: any amount of locked memory
  std::uint64_t rtprio = 0;                // RLIMIT_RTPRIO: highest fifo or rr priority
  std::uint64_t nice = 0;                  // RLIMIT_NICE: 20 - lowest nice value
  std::uint64_t memlock = 0;               // RLIMIT_MEMLOCK, bytes
  std::uint64_t realtime_time = no_limit;  // RLIMIT_RTTIME, us of CPU time without sleeping
};

// Sets the two capabilities from the text of /proc/self/status (CapEff); both are false without it.
void parse_capabilities(std::string_view status, Privileges& privileges);

// Reads the privileges of the calling thread.
Privileges read_privileges();

}  // namespace maploop::runtime
