#include "runtime/core/realtime_machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <sstream>
#include <string_view>
#include <system_error>

#include "runtime/core/realtime_text.h"

namespace maploop::runtime {
namespace {

// Views the text of a file that may be missing; valid as long as the machine's text.
std::string_view view(const std::optional<std::string>& file) {
  return file ? std::string_view(*file) : std::string_view();
}

RealtimeSetting assess_kernel(const MachineText& machine) {
  const RealtimeRequest kernel{"kernel", "PREEMPT_RT"};
  constexpr const char* remedy_text =
      "install and boot a PREEMPT_RT kernel (Debian: linux-image-rt-amd64)";
  if (!machine.version && !machine.realtime) {
    return kernel.unknown("/proc/version cannot be read", remedy_text);
  }
  const std::string_view version = view(machine.version);
  const auto has = [version](std::string_view word) {
    return version.find(word) != std::string_view::npos;
  };
  if (machine.realtime == "1" || has("PREEMPT_RT") || has("PREEMPT RT")) {
    return kernel.granted("PREEMPT_RT");
  }
  return kernel.limiting(
      has("PREEMPT_DYNAMIC") ? "PREEMPT_DYNAMIC"
      : has("PREEMPT")       ? "PREEMPT"
                             : "none",
      "without PREEMPT_RT the kernel itself is late by milliseconds now and then", remedy_text);
}

RealtimeSetting assess_throttling(const MachineText& machine) {
  // With a smaller share, a driver's burst could be cut off; the kernel's default is 95 %.
  constexpr double enough_share = 0.9;
  constexpr const char* remedy_text = "as root: sysctl kernel.sched_rt_runtime_us=950000";
  const RealtimeRequest share{"real-time throttling", "at least 90 % for real-time threads"};
  const auto runtime = parse_integer(view(machine.rt_runtime_us));
  const auto period = parse_integer(view(machine.rt_period_us));
  if (runtime == -1) return share.granted("off");
  if (!runtime || !period || *runtime < 0 || *period <= 0) {
    return share.unknown("/proc/sys/kernel/sched_rt_runtime_us is not readable", remedy_text);
  }
  const std::string text = std::to_string(*runtime) + " of " + std::to_string(*period) + " us";
  if (static_cast<double>(*runtime) >= enough_share * static_cast<double>(*period))
    return share.granted(text);
  return share.limiting(text, "the kernel stops fifo and rr threads for the rest of each period",
                        remedy_text);
}

RealtimeSetting assess_frequency(const MachineText& machine) {
  const RealtimeRequest frequency{"CPU frequency", "governor performance"};
  if (machine.governors.empty()) {
    return frequency.unknown(
        "no cpufreq in /sys: the firmware, or the host of a virtual machine, decides",
        "choose the performance profile there");
  }
  std::string all;
  std::vector<std::string> names;
  std::vector<int> others;
  for (const auto& [cpu, governor] : machine.governors) {
    if (governor != "performance") others.push_back(cpu);
    if (std::find(names.begin(), names.end(), governor) != names.end()) continue;
    names.push_back(governor);
    all += (all.empty() ? "" : ", ") + governor;
  }
  if (others.empty()) return frequency.granted(all);
  return frequency.limiting(all, "CPU " + to_cpu_list(others) + " may run slowly when work comes",
                            "as root: cpupower frequency-set -g performance");
}

// Returns the share of the time since boot, in percent, that the host gave to others while this
// machine had work. proc(5): user nice system idle iowait irq softirq steal.
std::optional<double> stolen(std::string_view stat) {
  std::istringstream line(std::string(stat.substr(0, stat.find('\n'))));
  std::string name;
  std::array<double, 8> ticks{};
  line >> name;
  for (double& value : ticks) line >> value;
  if (!line || name != "cpu") return {};
  const double sum = std::accumulate(ticks.begin(), ticks.end(), 0.0);
  return sum > 0.0 ? 100.0 * ticks[7] / sum : 0.0;
}

RealtimeSetting assess_virtual_machine(const MachineText& machine) {
  constexpr const char* remedy_text =
      "run on the machine itself, or give each virtual CPU a core of its own";
  const RealtimeRequest machine_itself{"virtual machine", "none"};
  // On x86 the flags show this; other machines do not report it.
  const auto flags = line_value(view(machine.cpuinfo), "flags");
  const auto steal = stolen(view(machine.stat));
  const bool shown =
      flags && (' ' + std::string(*flags) + ' ').find(" hypervisor ") != std::string::npos;
  if (!shown && steal.value_or(0.0) == 0.0) {
    return flags ? machine_itself.granted("none")
                 : machine_itself.unknown("/proc/cpuinfo has no flags", remedy_text);
  }
  return machine_itself.limiting(
      steal ? fmt::format("virtual, {:.2f} % of the time stolen", *steal) : "virtual",
      "the host runs others on this machine's CPUs, unseen by its kernel", remedy_text);
}

RealtimeSetting assess_isolation(const MachineText& machine) {
  constexpr const char* remedy_text =
      "boot with isolcpus=LIST and bind the real-time threads there, on a machine with CPUs to "
      "spare";
  const RealtimeRequest cpus{"isolated CPUs", "some, for bound threads alone"};
  const auto isolated = parse_cpu_list(view(machine.isolated_cpus));
  if (!machine.isolated_cpus || !isolated) {
    return cpus.unknown("/sys/devices/system/cpu/isolated is not readable", remedy_text);
  }
  std::string text = isolated->empty() ? "none" : to_cpu_list(*isolated);
  if (machine.online_cpus) text += " of " + *machine.online_cpus;
  return isolated->empty() ? cpus.limiting(text, "every program may run on any CPU", remedy_text)
                           : cpus.granted(text);
}

RealtimeSetting assess_clock(const MachineText& machine) {
  // All others are read by a system call, or from a device.
  constexpr std::array fast{"tsc", "arch_sys_counter", "kvm-clock", "hyperv_clocksource_tsc_page"};
  constexpr const char* remedy_text =
      "see why the kernel has left the processor's counter (dmesg | grep -i clocksource)";
  const RealtimeRequest clock{"clock", "the processor's counter"};
  if (!machine.clock_source) {
    return clock.unknown("/sys/devices/system/clocksource is not readable", remedy_text);
  }
  if (std::find(fast.begin(), fast.end(), *machine.clock_source) != fast.end())
    return clock.granted(*machine.clock_source);
  return clock.limiting(*machine.clock_source,
                        "each reading of the time takes a microsecond or more", remedy_text);
}

// The file names all choices, with the one in force in brackets.
RealtimeSetting assess_huge_pages(const MachineText& machine) {
  constexpr const char* remedy_text =
      "as root: echo madvise > /sys/kernel/mm/transparent_hugepage/enabled";
  const RealtimeRequest pages{"huge pages", "madvise or never"};
  const std::string_view text = view(machine.huge_pages);
  const std::size_t open = text.find('['), close = text.find(']');
  if (open == std::string_view::npos || close == std::string_view::npos || close < open) {
    return pages.unknown("the kernel has none, or /sys/kernel/mm is not readable", remedy_text);
  }
  const std::string choice(text.substr(open + 1, close - open - 1));
  if (choice != "always") return pages.granted(choice);
  return pages.limiting(
      choice, "the kernel joins pages in the background, and who touches them waits", remedy_text);
}

RealtimeSetting assess_interrupts(const MachineText& machine, const std::vector<int>& isolated) {
  const RealtimeRequest interrupts{"interrupts", "none on isolated CPUs"};
  std::vector<int> there;
  for (const auto& [number, list] : machine.interrupts) {
    const std::vector<int> cpus = parse_cpu_list(list).value_or(std::vector<int>{});
    if (std::any_of(cpus.begin(), cpus.end(), [&](int cpu) {
          return std::find(isolated.begin(), isolated.end(), cpu) != isolated.end();
        })) {
      there.push_back(number);
    }
  }
  if (there.empty()) return interrupts.granted("none");
  return interrupts.limiting("number " + to_cpu_list(there) + " on CPU " + to_cpu_list(isolated),
                             "they interrupt the threads that are bound there",
                             "disable irqbalance; as root, write the other CPUs to "
                             "/proc/irq/NUMBER/smp_affinity_list");
}

}  // namespace

MachineText read_machine(const std::filesystem::path& root) {
  const std::filesystem::path kernel = root / "proc/sys/kernel";
  const std::filesystem::path cpus = root / "sys/devices/system/cpu";
  MachineText machine;
  machine.version = read_system_file(root / "proc/version");
  machine.realtime = read_system_file(root / "sys/kernel/realtime");
  machine.rt_runtime_us = read_system_file(kernel / "sched_rt_runtime_us");
  machine.rt_period_us = read_system_file(kernel / "sched_rt_period_us");
  machine.cpuinfo = read_system_file(root / "proc/cpuinfo");
  machine.stat = read_system_file(root / "proc/stat");
  machine.online_cpus = read_system_file(cpus / "online");
  machine.isolated_cpus = read_system_file(cpus / "isolated");
  for (const int cpu : parse_cpu_list(view(machine.online_cpus)).value_or(std::vector<int>{})) {
    if (auto governor =
            read_system_file(cpus / ("cpu" + std::to_string(cpu)) / "cpufreq/scaling_governor")) {
      machine.governors.emplace_back(cpu, std::move(*governor));
    }
  }
  machine.clock_source =
      read_system_file(root / "sys/devices/system/clocksource/clocksource0/current_clocksource");
  machine.huge_pages = read_system_file(root / "sys/kernel/mm/transparent_hugepage/enabled");
  std::error_code error;  // a folder that cannot be read has no interrupts
  const std::filesystem::directory_iterator end;
  for (std::filesystem::directory_iterator irq(root / "proc/irq", error); !error && irq != end;
       irq.increment(error)) {
    const auto number = parse_integer(irq->path().filename().string());
    auto list = read_system_file(irq->path() / "effective_affinity_list");
    if (number && list)
      machine.interrupts.emplace_back(static_cast<int>(*number), std::move(*list));
  }
  std::sort(machine.interrupts.begin(), machine.interrupts.end());
  return machine;
}

std::vector<RealtimeSetting> assess(const MachineText& machine) {
  std::vector<RealtimeSetting> settings{assess_kernel(machine),    assess_throttling(machine),
                                        assess_frequency(machine), assess_virtual_machine(machine),
                                        assess_isolation(machine), assess_clock(machine),
                                        assess_huge_pages(machine)};
  const auto isolated = parse_cpu_list(view(machine.isolated_cpus));
  if (isolated && !isolated->empty()) settings.push_back(assess_interrupts(machine, *isolated));
  return settings;
}

}  // namespace maploop::runtime
