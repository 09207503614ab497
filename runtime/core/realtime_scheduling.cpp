#include "runtime/core/realtime_scheduling.h"

#include <fmt/format.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "runtime/core/realtime_memory.h"
#include "runtime/core/realtime_text.h"

namespace maploop::runtime {
namespace {

// This is the layout of sched_setattr(2); glibc 2.36 has neither the type nor the calls.
struct SchedulingAttributes {
  std::uint32_t size = sizeof(SchedulingAttributes);
  std::uint32_t policy = 0;
  std::uint64_t flags = 0;
  std::int32_t nice = 0;
  std::uint32_t priority = 0;
  std::uint64_t runtime = 0;  // ns
  std::uint64_t deadline = 0;
  std::uint64_t period = 0;
};
constexpr std::uint32_t deadline_policy = 6;  // SCHED_DEADLINE
constexpr std::uint64_t reset_on_fork = 0x1;  // SCHED_FLAG_RESET_ON_FORK

// Both apply to the calling thread and return 0 or errno.
int set_attributes(const SchedulingAttributes& attributes) {
  return syscall(SYS_sched_setattr, 0, &attributes, 0) == 0 ? 0 : errno;
}
int get_attributes(SchedulingAttributes& attributes) {
  return syscall(SYS_sched_getattr, 0, &attributes, sizeof attributes, 0) == 0 ? 0 : errno;
}

std::string other_text(int nice) {
  return nice == 0 ? "other" : "other nice " + std::to_string(nice);
}

std::string policy_text(const SchedulingAttributes& a) {
  const auto ms = [](std::uint64_t ns) {
    return static_cast<double>(static_cast<std::int64_t>(ns)) / 1e6;
  };
  const int priority = static_cast<int>(a.priority);
  switch (a.policy) {
    case SCHED_OTHER:
      return other_text(a.nice);
    case SCHED_FIFO:
      return fmt::format("fifo {}", priority);
    case SCHED_RR:
      return fmt::format("rr {}", priority);
    case SCHED_BATCH:
      return "batch";
    case SCHED_IDLE:
      return "idle";
    case deadline_policy:
      return fmt::format("deadline {}/{}/{} ms", ms(a.runtime), ms(a.deadline), ms(a.period));
    default:
      return fmt::format("policy {}", a.policy);
  }
}

// Returns which value is out of the range of its policy, or an empty text. It is checked before the
// kernel, which would read a negative number as a large one.
std::string out_of_range(const Scheduling& s) {
  switch (s.policy) {
    case SchedulingPolicy::inherited:
      return {};
    case SchedulingPolicy::other:
      return s.nice && (*s.nice < -20 || *s.nice > 19) ? "nice values are -20 to 19" : "";
    case SchedulingPolicy::fifo:
    case SchedulingPolicy::rr:
      return s.priority < 1 || s.priority > 99 ? "priorities are 1 to 99" : "";
    case SchedulingPolicy::deadline:
      return s.runtime < Duration(1024) || s.runtime > s.deadline || s.deadline > s.period
                 ? "1.024 us <= runtime <= deadline <= period must hold"
                 : "";
  }
  return {};
}

SchedulingAttributes attributes_of(const Scheduling& s, const SchedulingAttributes& before) {
  SchedulingAttributes a;
  switch (s.policy) {
    case SchedulingPolicy::inherited:
      return before;
    case SchedulingPolicy::other:
      a.policy = SCHED_OTHER;
      a.nice = s.nice.value_or(before.nice);
      break;
    case SchedulingPolicy::fifo:
    case SchedulingPolicy::rr:
      a.policy = s.policy == SchedulingPolicy::fifo ? SCHED_FIFO : SCHED_RR;
      a.priority = static_cast<std::uint32_t>(s.priority);
      break;
    case SchedulingPolicy::deadline:
      a.policy = deadline_policy;
      a.flags = reset_on_fork;  // without it the thread could not start others
      a.runtime = static_cast<std::uint64_t>(s.runtime.count());
      a.deadline = static_cast<std::uint64_t>(s.deadline.count());
      a.period = static_cast<std::uint64_t>(s.period.count());
      break;
  }
  return a;
}

int lowest_nice(const Privileges& privileges) {
  return 20 - static_cast<int>(std::clamp<std::uint64_t>(privileges.nice, 1, 40));
}

RealtimeSetting apply_policy(const std::string& name, const Scheduling& scheduling) {
  const RealtimeRequest request{name + ": scheduling", to_string(scheduling)};
  SchedulingAttributes before;
  int error = get_attributes(before);
  const std::string range = out_of_range(scheduling);
  if (!range.empty()) {
    error = EINVAL;
  } else if (error == 0 && scheduling.policy != SchedulingPolicy::inherited) {
    error = set_attributes(attributes_of(scheduling, before));
  }
  const std::string granted = read_scheduling().policy;
  const std::string wanted = scheduling.policy == SchedulingPolicy::other && !scheduling.nice
                                 ? other_text(before.nice)
                                 : request.asked;
  if (error == 0 && (scheduling.policy == SchedulingPolicy::inherited || granted == wanted)) {
    return request.granted(granted);
  }
  const auto [reason, remedy] = explain_refusal(scheduling, error, read_privileges());
  return request.refused(granted, reason, remedy);
}

RealtimeSetting apply_cpus(const std::string& name, const std::vector<int>& cpus) {
  std::vector<int> asked = cpus;
  std::sort(asked.begin(), asked.end());
  asked.erase(std::unique(asked.begin(), asked.end()), asked.end());
  const RealtimeRequest request{name + ": CPUs", to_cpu_list(asked)};
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int cpu : asked) {
    if (cpu >= 0 && cpu < CPU_SETSIZE) CPU_SET(static_cast<std::size_t>(cpu), &set);
  }
  const int error = sched_setaffinity(0, sizeof set, &set) == 0 ? 0 : errno;
  const std::vector<int> granted = read_scheduling().cpus;
  if (granted == asked) return request.granted(to_cpu_list(granted));
  const std::string online = read_system_file("/sys/devices/system/cpu/online").value_or("unknown");
  return request.refused(to_cpu_list(granted),
                         error == EBUSY || error == EPERM
                             ? "a deadline thread cannot be bound to CPUs"
                             : "some of them do not exist, or are not in this process's cpuset",
                         "choose from the CPUs online, " + online +
                             ", that the cpuset (container, systemd AllowedCPUs) leaves");
}

RealtimeSetting apply_timer_slack(const std::string& name, Duration slack) {
  const auto text = [](Duration d) { return std::to_string(d.count()) + " ns"; };
  const RealtimeRequest request{name + ": timer slack", text(slack)};
  if (slack > Duration::zero()) {
    prctl(PR_SET_TIMERSLACK, static_cast<unsigned long>(slack.count()), 0, 0, 0);
  }
  const Duration granted = read_scheduling().timer_slack;
  if (granted == slack) return request.granted(text(granted));
  return request.refused(
      text(granted), granted == Duration::zero() ? "real-time threads have none" : "out of range",
      "ask for 1 ns to 2 s, of a thread that is not real-time");
}

}  // namespace

SchedulingState read_scheduling() {
  SchedulingState state;
  SchedulingAttributes attributes;
  if (get_attributes(attributes) == 0) state.policy = policy_text(attributes);
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) {
    for (std::size_t cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
      if (CPU_ISSET(cpu, &set)) state.cpus.push_back(static_cast<int>(cpu));
    }
  }
  const int slack = prctl(PR_GET_TIMERSLACK, 0, 0, 0, 0);
  if (slack > 0) state.timer_slack = Duration(slack);
  return state;
}

std::string to_string(const Scheduling& scheduling) {
  return scheduling.policy == SchedulingPolicy::inherited
             ? "as inherited"
             : policy_text(attributes_of(scheduling, {}));
}

std::pair<std::string, std::string> explain_refusal(const Scheduling& scheduling, int error,
                                                    const Privileges& privileges) {
  constexpr const char* needed_capability =
      "run as root, or give the program the capability: setcap cap_sys_nice+ep PROGRAM";
  const bool fixed =
      scheduling.policy == SchedulingPolicy::fifo || scheduling.policy == SchedulingPolicy::rr;
  const bool deadline = scheduling.policy == SchedulingPolicy::deadline;
  if (const std::string range = out_of_range(scheduling); !range.empty()) {
    return {range, "correct the value in the configuration"};
  }
  if (error == EPERM || error == EACCES) {
    if (privileges.sys_nice && fixed) {
      return {"CAP_SYS_NICE is there, but this control group gives real-time threads no time",
              "as root: echo 950000 > cpu.rt_runtime_us in the folder of the cpu control group"};
    }
    if (privileges.sys_nice && deadline) {
      return {"CAP_SYS_NICE is there, but a deadline thread must be allowed on all CPUs",
              "do not bind the thread, or the process, to CPUs"};
    }
    if (fixed) {
      return {"no CAP_SYS_NICE, and RLIMIT_RTPRIO is " + std::to_string(privileges.rtprio),
              "add '@GROUP - rtprio 99' to a file in /etc/security/limits.d and log in again; or "
              "run as root"};
    }
    if (deadline) return {"deadline scheduling needs CAP_SYS_NICE", needed_capability};
    return {"no CAP_SYS_NICE, and RLIMIT_NICE allows nice values from " +
                std::to_string(lowest_nice(privileges)),
            "add '@GROUP - nice -20' to a file in /etc/security/limits.d and log in again; or run "
            "as root"};
  }
  if (deadline && error == EBUSY) {
    return {"the deadline threads together would take more than the CPUs have to give",
            "lower runtime, or raise period"};
  }
  if (error == 0) {
    return {"the kernel accepted it and says otherwise", "see what else manages this process"};
  }
  return {std::strerror(error), "see sched_setattr(2)"};
}

std::vector<RealtimeSetting> apply_scheduling(const std::string& name,
                                              const Scheduling& scheduling) {
  std::vector<RealtimeSetting> settings;
  // The CPUs are set first, because the policy may need free time on them.
  if (!scheduling.cpus.empty()) settings.push_back(apply_cpus(name, scheduling.cpus));
  settings.insert(settings.begin(), apply_policy(name, scheduling));
  if (scheduling.timer_slack != Duration::zero()) {
    settings.push_back(apply_timer_slack(name, scheduling.timer_slack));
  }
  if (scheduling.prefaulted_stack_kb != 0) {
    settings.push_back(prefault_stack(name, scheduling.prefaulted_stack_kb));
  }
  return settings;
}

RealtimeSetting assess_time_limit(const Privileges& privileges) {
  const RealtimeRequest request{"real-time CPU time", "unlimited"};
  if (privileges.realtime_time == Privileges::no_limit) return request.granted("unlimited");
  return request.limiting(
      std::to_string(privileges.realtime_time) + " us",
      "RLIMIT_RTTIME: the kernel ends a process whose real-time thread runs that long without "
      "sleeping",
      "ulimit -R unlimited, or LimitRTTIME=infinity in the systemd unit");
}

}  // namespace maploop::runtime
