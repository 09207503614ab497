#include "runtime/vehicle/health/process_usage.h"

#include <sys/resource.h>

namespace maploop::vehicle {
namespace {

rusage usage() {
  rusage u{};
  getrusage(RUSAGE_SELF, &u);
  return u;
}

}  // namespace

double process_cpu_seconds() {
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  const rusage u = usage();
  return seconds(u.ru_utime) + seconds(u.ru_stime);
}

std::uint64_t process_peak_memory() {
  return static_cast<std::uint64_t>(usage().ru_maxrss) * 1024;
}

}  // namespace maploop::vehicle
