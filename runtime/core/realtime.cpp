#include "runtime/core/realtime.h"

namespace maploop::runtime {

RealtimeReport prepare_process(const MemoryParameters& memory) {
  const Privileges privileges = read_privileges();
  RealtimeReport report;
  append(report, prepare_memory(memory, privileges));
  append(report, {assess_time_limit(privileges)});
  append(report, assess(read_machine()));
  return report;
}

void append(RealtimeReport& report, const std::vector<RealtimeSetting>& settings) {
  report.settings.insert(report.settings.end(), settings.begin(), settings.end());
}

}  // namespace maploop::runtime
