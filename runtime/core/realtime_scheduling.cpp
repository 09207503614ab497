#include "runtime/core/realtime_scheduling.h"

#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <tuple>

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
constexpr std::uint32_t kDeadline = 6;       // SCHED_DEADLINE
constexpr std::uint64_t kResetOnFork = 0x1;  // SCHED_FLAG_RESET_ON_FORK

// Both apply to the calling thread and return 0 or errno.
int set_attributes(const SchedulingAttributes& attributes) {
  return syscall(SYS_sched_setattr, 0, &attributes, 0) == 0 ? 0 : errno;
}
int get_attributes(SchedulingAttributes& attributes) {
  return syscall(SYS_sched_getattr, 0, &attributes, sizeof attributes, 0) == 0 ? 0 : errno;
}

std::string milliseconds_text(Duration d) {
  std::string text = std::to_string(static_cast<double>(d.count()) * 1e-6);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string deadline_text(Duration runtime, Duration deadline, Duration period) {
  return "deadline " + milliseconds_text(runtime) + '/' + milliseconds_text(deadline) + '/' +
         milliseconds_text(period) + " ms";
}

std::string other_text(int nice) {
  return nice == 0 ? "other" : "other nice " + std::to_string(nice);
}

std::string policy_text(const SchedulingAttributes& a) {
  const auto duration = [](std::uint64_t ns) { return Duration(static_cast<std::int64_t>(ns)); };
  switch (a.policy) {
    case SCHED_OTHER:
      return other_text(a.nice);
    case SCHED_FIFO:
      return "fifo " + std::to_string(a.priority);
    case SCHED_RR:
      return "rr " + std::to_string(a.priority);
    case SCHED_BATCH:
      return "batch";
    case SCHED_IDLE:
      return "idle";
    case kDeadline:
      return deadline_text(duration(a.runtime), duration(a.deadline), duration(a.period));
    default:
      return "policy " + std::to_string(a.policy);
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
      a.policy = kDeadline;
      a.flags = kResetOnFork;  // without it the thread could not start others
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
  RealtimeSetting setting{
      name + ": scheduling", to_string(scheduling), {}, Verdict::granted, {}, {}};
  SchedulingAttributes before;
  int error = get_attributes(before);
  const std::string range = out_of_range(scheduling);
  if (!range.empty()) {
    error = EINVAL;
  } else if (error == 0 && scheduling.policy != SchedulingPolicy::inherited) {
    error = set_attributes(attributes_of(scheduling, before));
  }
  setting.granted = read_scheduling().policy;
  const std::string wanted = scheduling.policy == SchedulingPolicy::other && !scheduling.nice
                                 ? other_text(before.nice)
                                 : setting.asked;
  if (error == 0 &&
      (scheduling.policy == SchedulingPolicy::inherited || setting.granted == wanted)) {
    return setting;
  }
  setting.verdict = Verdict::refused;
  std::tie(setting.reason, setting.remedy) = explain_refusal(scheduling, error, read_privileges());
  return setting;
}

RealtimeSetting apply_cpus(const std::string& name, const std::vector<int>& cpus) {
  std::vector<int> asked = cpus;
  std::sort(asked.begin(), asked.end());
  asked.erase(std::unique(asked.begin(), asked.end()), asked.end());
  RealtimeSetting setting{name + ": CPUs", to_cpu_list(asked), {}, Verdict::granted, {}, {}};
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int cpu : asked) {
    if (cpu >= 0 && cpu < CPU_SETSIZE) CPU_SET(static_cast<std::size_t>(cpu), &set);
  }
  const int error = sched_setaffinity(0, sizeof set, &set) == 0 ? 0 : errno;
  const std::vector<int> granted = read_scheduling().cpus;
  setting.granted = to_cpu_list(granted);
  if (granted == asked) return setting;
  setting.verdict = Verdict::refused;
  const std::string online = read_system_file("/sys/devices/system/cpu/online").value_or("unknown");
  setting.reason = error == EBUSY || error == EPERM
                       ? "a deadline thread cannot be bound to CPUs"
                       : "some of them do not exist, or are not in this process's cpuset";
  setting.remedy = "choose from the CPUs online, " + online +
                   ", that the cpuset (container, systemd AllowedCPUs) leaves";
  return setting;
}

RealtimeSetting apply_timer_slack(const std::string& name, Duration slack) {
  const auto text = [](Duration d) { return std::to_string(d.count()) + " ns"; };
  RealtimeSetting setting{name + ": timer slack", text(slack), {}, Verdict::granted, {}, {}};
  if (slack > Duration::zero()) {
    prctl(PR_SET_TIMERSLACK, static_cast<unsigned long>(slack.count()), 0, 0, 0);
  }
  const Duration granted = read_scheduling().timer_slack;
  setting.granted = text(granted);
  if (granted == slack) return setting;
  setting.verdict = Verdict::refused;
  setting.reason = granted == Duration::zero() ? "real-time threads have none" : "out of range";
  setting.remedy = "ask for 1 ns to 2 s, of a thread that is not real-time";
  return setting;
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
  switch (scheduling.policy) {
    case SchedulingPolicy::inherited:
      return "as inherited";
    case SchedulingPolicy::other:
      return other_text(scheduling.nice.value_or(0));
    case SchedulingPolicy::fifo:
      return "fifo " + std::to_string(scheduling.priority);
    case SchedulingPolicy::rr:
      return "rr " + std::to_string(scheduling.priority);
    case SchedulingPolicy::deadline:
      return deadline_text(scheduling.runtime, scheduling.deadline, scheduling.period);
  }
  return "unknown";
}

std::pair<std::string, std::string> explain_refusal(const Scheduling& scheduling, int error,
                                                    const Privileges& privileges) {
  constexpr const char* kCapability =
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
    if (deadline) return {"deadline scheduling needs CAP_SYS_NICE", kCapability};
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
  RealtimeSetting setting{"real-time CPU time", "unlimited", "unlimited", Verdict::granted, {}, {}};
  if (privileges.realtime_time == Privileges::kUnlimited) return setting;
  setting.granted = std::to_string(privileges.realtime_time) + " us";
  setting.verdict = Verdict::limiting;
  setting.reason =
      "RLIMIT_RTTIME: the kernel ends a process whose real-time thread runs that long "
      "without sleeping";
  setting.remedy = "ulimit -R unlimited, or LimitRTTIME=infinity in the systemd unit";
  return setting;
}

}  // namespace maploop::runtime
