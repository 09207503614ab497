// This file reports the properties of this machine that make it less punctual, whatever the process
// requests.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/core/realtime_setting.h"

namespace maploop::runtime {

// Holds the files as the kernel wrote them; a file is unset if it is missing or may not be read.
struct MachineText {
  std::optional<std::string> version;                  // /proc/version
  std::optional<std::string> realtime;                 // /sys/kernel/realtime
  std::optional<std::string> rt_runtime_us;            // /proc/sys/kernel/sched_rt_runtime_us
  std::optional<std::string> rt_period_us;             // /proc/sys/kernel/sched_rt_period_us
  std::optional<std::string> cpuinfo;                  // /proc/cpuinfo
  std::optional<std::string> stat;                     // /proc/stat
  std::optional<std::string> online_cpus;              // /sys/devices/system/cpu/online
  std::optional<std::string> isolated_cpus;            // /sys/devices/system/cpu/isolated
  std::vector<std::pair<int, std::string>> governors;  // .../cpuN/cpufreq/scaling_governor
  // /sys/devices/system/clocksource/clocksource0/current_clocksource
  std::optional<std::string> clock_source;
  std::optional<std::string> huge_pages;  // /sys/kernel/mm/transparent_hugepage/enabled
  std::vector<std::pair<int, std::string>> interrupts;  // /proc/irq/N/effective_affinity_list
};

// `root` is the folder of proc and sys.
MachineText read_machine(const std::filesystem::path& root = "/");

// Returns "kernel", "real-time throttling", "CPU frequency", "virtual machine", "isolated CPUs",
// "clock", "huge pages", and, where CPUs are isolated, "interrupts".
std::vector<RealtimeSetting> assess(const MachineText& machine);

}  // namespace maploop::runtime
