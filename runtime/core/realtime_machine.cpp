#include "runtime/core/realtime_machine.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <string_view>

#include "runtime/core/realtime_text.h"

namespace maploop::runtime {
namespace {

RealtimeSetting unknown(std::string name, std::string asked, std::string reason,
                        std::string remedy) {
  return {std::move(name),  std::move(asked),  "unknown",
          Verdict::unknown, std::move(reason), std::move(remedy)};
}

// Views the text of a file that may be missing; valid as long as the machine's text.
std::string_view view(const std::optional<std::string>& file) {
  return file ? std::string_view(*file) : std::string_view();
}

RealtimeSetting assess_kernel(const MachineText& machine) {
  RealtimeSetting setting{"kernel", "PREEMPT_RT", {}, Verdict::granted, {}, {}};
  constexpr const char* kRemedy =
      "install and boot a PREEMPT_RT kernel (Debian: linux-image-rt-amd64)";
  if (!machine.version && !machine.realtime) {
    return unknown(setting.name, setting.asked, "/proc/version cannot be read", kRemedy);
  }
  const std::string_view version = view(machine.version);
  const auto has = [version](std::string_view word) {
    return version.find(word) != std::string_view::npos;
  };
  if (machine.realtime == "1" || has("PREEMPT_RT") || has("PREEMPT RT")) {
    setting.granted = "PREEMPT_RT";
    return setting;
  }
  setting.granted = has("PREEMPT_DYNAMIC") ? "PREEMPT_DYNAMIC"
                    : has("PREEMPT")       ? "PREEMPT"
                                           : "none";
  setting.verdict = Verdict::limiting;
  setting.reason = "without PREEMPT_RT the kernel itself is late by milliseconds now and then";
  setting.remedy = kRemedy;
  return setting;
}

RealtimeSetting assess_throttling(const MachineText& machine) {
  // With a smaller share, a driver's burst could be cut off; the kernel's default is 95 %.
  constexpr double kEnough = 0.9;
  constexpr const char* kRemedy = "as root: sysctl kernel.sched_rt_runtime_us=950000";
  RealtimeSetting setting{
      "real-time throttling", "at least 90 % for real-time threads", {}, Verdict::granted, {}, {}};
  const auto runtime = parse_integer(view(machine.rt_runtime_us));
  const auto period = parse_integer(view(machine.rt_period_us));
  if (runtime == -1) {
    setting.granted = "off";
    return setting;
  }
  if (!runtime || !period || *runtime < 0 || *period <= 0) {
    return unknown(setting.name, setting.asked,
                   "/proc/sys/kernel/sched_rt_runtime_us is not readable", kRemedy);
  }
  setting.granted = std::to_string(*runtime) + " of " + std::to_string(*period) + " us";
  if (static_cast<double>(*runtime) >= kEnough * static_cast<double>(*period)) return setting;
  setting.verdict = Verdict::limiting;
  setting.reason = "the kernel stops fifo and rr threads for the rest of each period";
  setting.remedy = kRemedy;
  return setting;
}

RealtimeSetting assess_frequency(const MachineText& machine) {
  RealtimeSetting setting{"CPU frequency", "governor performance", {}, Verdict::granted, {}, {}};
  if (machine.governors.empty()) {
    return unknown(setting.name, setting.asked,
                   "no cpufreq in /sys: the firmware, or the host of a virtual machine, decides",
                   "choose the performance profile there");
  }
  std::vector<std::string> names;
  std::vector<int> others;
  for (const auto& [cpu, governor] : machine.governors) {
    if (std::find(names.begin(), names.end(), governor) == names.end()) names.push_back(governor);
    if (governor != "performance") others.push_back(cpu);
  }
  for (const std::string& name : names)
    setting.granted += (setting.granted.empty() ? "" : ", ") + name;
  if (others.empty()) return setting;
  setting.verdict = Verdict::limiting;
  setting.reason = "CPU " + to_cpu_list(others) + " may run slowly when work comes";
  setting.remedy = "as root: cpupower frequency-set -g performance";
  return setting;
}

// Returns the share of the time since boot, in percent, that the host gave to others while this
// machine had work. proc(5): user nice system idle iowait irq softirq steal.
std::optional<double> stolen(std::string_view stat) {
  if (stat.substr(0, 4) != "cpu ") return {};
  stat = stat.substr(4, stat.find('\n') - 4);
  std::array<double, 8> ticks{};
  double sum = 0.0;
  for (double& value : ticks) {
    while (!stat.empty() && stat.front() == ' ') stat.remove_prefix(1);
    std::uint64_t count = 0;
    const auto [end, error] = std::from_chars(stat.data(), stat.data() + stat.size(), count);
    if (error != std::errc{}) return {};
    stat.remove_prefix(static_cast<std::size_t>(end - stat.data()));
    value = static_cast<double>(count);
    sum += value;
  }
  return sum > 0.0 ? 100.0 * ticks[7] / sum : 0.0;
}

RealtimeSetting assess_virtual_machine(const MachineText& machine) {
  constexpr const char* kRemedy =
      "run on the machine itself, or give each virtual CPU a core of its own";
  RealtimeSetting setting{"virtual machine", "none", "none", Verdict::granted, {}, {}};
  // On x86 the flags show this; other machines do not report it.
  const auto flags = line_value(view(machine.cpuinfo), "flags");
  const auto steal = stolen(view(machine.stat));
  const bool is_virtual =
      flags && (' ' + std::string(*flags) + ' ').find(" hypervisor ") != std::string::npos;
  if (!flags && (!steal || *steal == 0.0)) {
    return unknown(setting.name, setting.asked, "/proc/cpuinfo has no flags", kRemedy);
  }
  if (!is_virtual && (!steal || *steal == 0.0)) return setting;
  setting.granted = "virtual";
  if (steal) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), ", %.2f %% of the time stolen", *steal);
    setting.granted += text.data();
  }
  setting.verdict = Verdict::limiting;
  setting.reason = "the host runs others on this machine's CPUs, unseen by its kernel";
  setting.remedy = kRemedy;
  return setting;
}

RealtimeSetting assess_isolation(const MachineText& machine) {
  constexpr const char* kRemedy =
      "boot with isolcpus=LIST and bind the real-time threads there, on a machine with CPUs to "
      "spare";
  RealtimeSetting setting{
      "isolated CPUs", "some, for bound threads alone", {}, Verdict::granted, {}, {}};
  const auto isolated = parse_cpu_list(view(machine.isolated_cpus));
  if (!machine.isolated_cpus || !isolated) {
    return unknown(setting.name, setting.asked, "/sys/devices/system/cpu/isolated is not readable",
                   kRemedy);
  }
  setting.granted = isolated->empty() ? "none" : to_cpu_list(*isolated);
  if (machine.online_cpus) setting.granted += " of " + *machine.online_cpus;
  if (!isolated->empty()) return setting;
  setting.verdict = Verdict::limiting;
  setting.reason = "every program may run on any CPU";
  setting.remedy = kRemedy;
  return setting;
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
  return machine;
}

std::vector<RealtimeSetting> assess(const MachineText& machine) {
  return {assess_kernel(machine), assess_throttling(machine), assess_frequency(machine),
          assess_virtual_machine(machine), assess_isolation(machine)};
}

}  // namespace maploop::runtime
