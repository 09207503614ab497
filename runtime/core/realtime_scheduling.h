// How the kernel schedules one thread: what to ask for, and what it says.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "msgs/time.h"
#include "runtime/core/realtime_privileges.h"
#include "runtime/core/realtime_setting.h"

namespace maploop::runtime {

enum class SchedulingPolicy : std::uint8_t {
  inherited,  // nothing is asked
  other,      // the kernel's default: fair shares
  fifo,       // before every `other`, until it sleeps
  rr,         // the same, taking turns with its equals
  deadline,   // `runtime` of CPU time within `deadline` of each `period`, guaranteed; before fifo
};

// What to ask for one thread. The default asks for nothing.
struct Scheduling {
  SchedulingPolicy policy = SchedulingPolicy::inherited;
  int priority = 0;         // of fifo and rr: 1..99, higher goes first
  std::optional<int> nice;  // of other: -20..19, lower gets a larger share; none: as inherited
  Duration runtime{};       // of deadline: at least 1024 ns <= runtime <= deadline <= period
  Duration deadline{};
  Duration period{};
  std::vector<int> cpus;        // where it may run; empty: as inherited. Not with `deadline`.
  Duration timer_slack{};       // how late `other` may be woken; 0: as inherited, usually 50 us
  int prefaulted_stack_kb = 0;  // of its stack, mapped before it starts its work

  static Scheduling fifo(int priority) {
    Scheduling scheduling;
    scheduling.policy = SchedulingPolicy::fifo;
    scheduling.priority = priority;
    return scheduling;
  }
};

// What the kernel says of the calling thread; empty or 0 where it says nothing.
struct SchedulingState {
  std::string policy;  // "fifo 50", "rr 3", "other", "other nice 5", "deadline 1/5/10 ms", "batch"
  std::vector<int> cpus;  // ascending
  Duration timer_slack{};
};
SchedulingState read_scheduling();

// The policy as SchedulingState says it.
std::string to_string(const Scheduling& scheduling);

// Why the kernel refused (`error`: errno of sched_setattr), and the remedy in one line.
std::pair<std::string, std::string> explain_refusal(const Scheduling& scheduling, int error,
                                                    const Privileges& privileges);

// Asks for the calling thread and reads back: an item each for the policy ("NAME: scheduling"), and
// for the CPUs, the timer slack and the stack where they were asked for. A refusal leaves that item
// as it was. Never throws for what the kernel says.
std::vector<RealtimeSetting> apply_scheduling(const std::string& name,
                                              const Scheduling& scheduling);

// RLIMIT_RTTIME, beyond which the kernel ends the process: "real-time CPU time".
RealtimeSetting assess_time_limit(const Privileges& privileges);

}  // namespace maploop::runtime
