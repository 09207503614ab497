#include "runtime/core/realtime_privileges.h"

#include <linux/capability.h>
#include <sys/resource.h>

#include <charconv>
#include <optional>

#include "runtime/core/realtime_text.h"

namespace maploop::runtime {
namespace {

std::uint64_t soft_limit(__rlimit_resource resource) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) return 0;
  return limit.rlim_cur == RLIM_INFINITY ? Privileges::no_limit : limit.rlim_cur;
}

}  // namespace

void parse_capabilities(std::string_view status, Privileges& privileges) {
  std::uint64_t effective = 0;
  if (const std::optional<std::string_view> mask = line_value(status, "CapEff")) {
    std::from_chars(mask->data(), mask->data() + mask->size(), effective, 16);
  }
  privileges.sys_nice = (effective >> CAP_SYS_NICE & 1) != 0;
  privileges.ipc_lock = (effective >> CAP_IPC_LOCK & 1) != 0;
}

Privileges read_privileges() {
  Privileges privileges;
  parse_capabilities(read_system_file("/proc/thread-self/status").value_or(""), privileges);
  privileges.rtprio = soft_limit(RLIMIT_RTPRIO);
  privileges.nice = soft_limit(RLIMIT_NICE);
  privileges.memlock = soft_limit(RLIMIT_MEMLOCK);
  privileges.realtime_time = soft_limit(RLIMIT_RTTIME);
  return privileges;
}

}  // namespace maploop::runtime
