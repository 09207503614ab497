// This file sets and reads how the kernel schedules one thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "msgs/time.h"
#include "runtime/core/realtime_privileges.h"
#include "runtime/core/realtime_setting.h"

namespace maploop::runtime {

enum class SchedulingPolicy : std::uint8_t {
  inherited,  // nothing is requested
  other,      // the kernel's default: fair shares
  fifo,       // before every `other`, until it sleeps
  rr,         // the same, in turns with threads of the same priority
  deadline,   // `runtime` of CPU time within `deadline` of each `period`, guaranteed; before fifo
};
constexpr std::array<std::string_view, 5> names_of(SchedulingPolicy) {
  return {"inherited", "other", "fifo", "rr", "deadline"};
}

// These are the requests for one thread. The default requests nothing.
struct Scheduling {
  SchedulingPolicy policy = SchedulingPolicy::inherited;
  int priority = 0;         // of fifo and rr: 1..99, higher goes first
  std::optional<int> nice;  // of other: -20..19, lower gets a larger share; unset: as inherited
  Duration runtime{};       // of deadline: at least 1024 ns <= runtime <= deadline <= period
  Duration deadline{};
  Duration period{};
  std::vector<int> cpus;        // allowed CPUs; empty: as inherited. Not with `deadline`.
  Duration timer_slack{};       // how late `other` may wake up; 0: as inherited, usually 50 us
  int prefaulted_stack_kb = 0;  // of its stack, mapped before it starts its work

  static Scheduling fifo(int priority) {
    Scheduling scheduling;
    scheduling.policy = SchedulingPolicy::fifo;
    scheduling.priority = priority;
    return scheduling;
  }
};

// This is what the kernel reports about the calling thread; empty or 0 if it reports nothing.
struct SchedulingState {
  std::string policy;  // "fifo 50", "rr 3", "other", "other nice 5", "deadline 1/5/10 ms", "batch"
  std::vector<int> cpus;  // ascending
  Duration timer_slack{};
};
SchedulingState read_scheduling();

// Returns the policy in the form of SchedulingState.
std::string to_string(const Scheduling& scheduling);

// Returns why the kernel refused (`error`: errno of sched_setattr), and the remedy in one line.
std::pair<std::string, std::string> explain_refusal(const Scheduling& scheduling, int error,
                                                    const Privileges& privileges);

// Requests the settings for the calling thread and reads them back. Returns one item for the policy
// ("NAME: scheduling"), and one for each of CPUs, timer slack and stack that was requested. A
// refused item stays unchanged. Never throws if the kernel refuses.
std::vector<RealtimeSetting> apply_scheduling(const std::string& name,
                                              const Scheduling& scheduling);

// Reports RLIMIT_RTTIME, beyond which the kernel ends the process, as "real-time CPU time".
RealtimeSetting assess_time_limit(const Privileges& privileges);

}  // namespace maploop::runtime
