// These tests use made-up machines.
#include "runtime/core/realtime_machine.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "runtime/core/realtime_privileges.h"
#include "runtime/core/realtime_text.h"
#include "tests/support/real_data.h"

namespace maploop::runtime {
namespace {

RealtimeSetting item(const MachineText& machine, std::string_view name) {
  const RealtimeReport report{assess(machine)};
  const RealtimeSetting* found = report.find(name);
  return found != nullptr ? *found : RealtimeSetting{};
}

// Returns a vehicle's computer with the best possible settings.
MachineText vehicle_computer() {
  MachineText machine;
  machine.version = "Linux version 6.1.0-18-rt-amd64 (debian) #1 SMP PREEMPT_RT Debian 6.1.76-1";
  machine.realtime = "1";
  machine.rt_runtime_us = "-1";
  machine.rt_period_us = "1000000";
  machine.cpuinfo = "processor\t: 0\nflags\t\t: fpu vme tsc constant_tsc\n";
  machine.stat = "cpu  100 0 100 1000 0 0 0 0 0 0\ncpu0 50 0 50 500 0 0 0 0 0 0\n";
  machine.online_cpus = "0-3";
  machine.isolated_cpus = "2-3";
  machine.governors = {{0, "performance"}, {1, "performance"}, {2, "performance"}};
  machine.clock_source = "arch_sys_counter";
  machine.huge_pages = "always [madvise] never";
  machine.interrupts = {{1, "0"}, {9, "0-1"}, {24, "1"}};
  return machine;
}

TEST(RealtimeMachine, APreemptRtKernelOnIsolatedCpusLeavesNothingToSay) {
  const RealtimeReport report{assess(vehicle_computer())};
  EXPECT_EQ(report.settings.size(), 8u);
  EXPECT_TRUE(report.all_granted()) << to_text(report);
  EXPECT_EQ(item(vehicle_computer(), "isolated CPUs").granted, "2-3 of 0-3");
}

// Checks what is said of a vehicle's computer with one change.
template <class Change>
void expect_item(std::string_view name, Change change, Verdict verdict, std::string_view granted) {
  MachineText machine = vehicle_computer();
  change(machine);
  const RealtimeSetting setting = item(machine, name);
  EXPECT_EQ(setting.verdict, verdict) << name << ", " << granted;
  EXPECT_EQ(setting.granted, granted) << name;
}

using enum Verdict;
using M = MachineText;

TEST(RealtimeMachine, KernelsAreKnownByTheirFileOrTheirName) {
  const auto kernel = [](const char* version) {
    return [=](M& m) { m.realtime.reset(), m.version = version; };
  };
  expect_item("kernel", kernel("Linux version 6.1.0 #1 SMP PREEMPT_DYNAMIC Debian"), limiting,
              "PREEMPT_DYNAMIC");
  expect_item("kernel", kernel("Linux version 4.19.0 #1 SMP Debian"), limiting, "none");
  expect_item("kernel", kernel("Linux version 4.9.0-rt #1 SMP PREEMPT RT Debian"), granted,
              "PREEMPT_RT");
  expect_item("kernel", kernel("Linux version 5.10.0-rt #1 SMP PREEMPT_RT Debian"), granted,
              "PREEMPT_RT");
}

TEST(RealtimeMachine, AClockThatIsReadByTheKernelIsLimiting) {
  expect_item(
      "clock", [](M& m) { m.clock_source = "hpet"; }, limiting, "hpet");
  expect_item(
      "clock", [](M& m) { m.clock_source = "tsc"; }, granted, "tsc");
  expect_item(
      "clock", [](M& m) { m.clock_source.reset(); }, unknown, "unknown");
}

TEST(RealtimeMachine, HugePagesForEveryProgramAreLimiting) {
  expect_item(
      "huge pages", [](M& m) { m.huge_pages = "[always] madvise never"; }, limiting, "always");
  expect_item(
      "huge pages", [](M& m) { m.huge_pages = "always madvise [never]"; }, granted, "never");
  for (const char* no_choice : {"", "]always[", "[always"}) {
    expect_item(
        "huge pages", [=](M& m) { m.huge_pages = no_choice; }, unknown, "unknown");
  }
}

TEST(RealtimeMachine, InterruptsOnIsolatedCpusAreNamed) {
  expect_item(
      "interrupts", [](M& m) { m.interrupts.emplace_back(30, "2"); }, limiting,
      "number 30 on CPU 2-3");
  expect_item(
      "interrupts", [](M& m) { m.interrupts.emplace_back(30, "no list"); }, granted, "none");
  MachineText without = vehicle_computer();
  without.isolated_cpus = "";
  EXPECT_EQ(item(without, "interrupts").name, "") << "the line of isolated CPUs says enough";
}

TEST(RealtimeMachine, ThrottlingBelowNinetyPercentIsLimiting) {
  const auto runtime = [](const char* text) { return [=](M& m) { m.rt_runtime_us = text; }; };
  const char* name = "real-time throttling";
  expect_item(name, runtime("950000"), granted, "950000 of 1000000 us");
  expect_item(name, runtime("500000"), limiting, "500000 of 1000000 us");
  expect_item(name, runtime("0"), limiting, "0 of 1000000 us");
  for (const char* no_number : {"", "much", "-2", "99999999999999999999"}) {
    expect_item(name, runtime(no_number), unknown, "unknown");
  }
  expect_item(
      name, [](M& m) { m.rt_runtime_us = "950000", m.rt_period_us = "0"; }, unknown, "unknown");
}

TEST(RealtimeMachine, CpusThatSaveEnergyAreListed) {
  expect_item(
      "CPU frequency", [](M& m) { m.governors.clear(); }, unknown, "unknown");
  MachineText machine = vehicle_computer();
  machine.governors = {{0, "performance"}, {1, "powersave"}, {2, "schedutil"}, {3, "powersave"}};
  const RealtimeSetting setting = item(machine, "CPU frequency");
  EXPECT_EQ(setting.verdict, limiting);
  EXPECT_EQ(setting.granted, "performance, powersave, schedutil");
  EXPECT_EQ(setting.reason, "CPU 1-3 may run slowly when work comes");
}

TEST(RealtimeMachine, AVirtualMachineSaysHowMuchWasStolen) {
  const auto machine = [](const char* flags, const char* stat) {
    return [=](M& m) { m.cpuinfo = flags, m.stat = stat; };
  };
  const char *name = "virtual machine", *hypervisor = "flags\t: fpu vme hypervisor\n",
             *none = "flags\t: fpu nohypervisor hypervisor2\n";
  expect_item(name, machine(hypervisor, "cpu  100 0 100 700 0 0 0 100 0 0\n"), limiting,
              "virtual, 10.00 % of the time stolen");
  // Kernels before 2.6.11 have no such column.
  expect_item(name, machine(hypervisor, "cpu  100 0"), limiting, "virtual");
  // Stolen time betrays one that hides itself.
  expect_item(name, machine(none, "cpu  1 0 1 1 0 0 0 1 0 0\n"), limiting,
              "virtual, 25.00 % of the time stolen");
  expect_item(name, machine(none, "cpu  100 0 100 1000 0 0 0 0 0 0\n"), granted, "none");
  expect_item(name, machine("Features\t: fp asimd\n", "cpu  100 0 100 1000 0 0 0 0 0 0\n"), unknown,
              "unknown");
}

TEST(RealtimeMachine, NoIsolatedCpusIsLimitingNoFileIsUnknown) {
  expect_item(
      "isolated CPUs", [](M& m) { m.isolated_cpus = ""; }, limiting, "none of 0-3");
  expect_item(
      "isolated CPUs", [](M& m) { m.isolated_cpus = "2-"; }, unknown, "unknown");
  expect_item(
      "isolated CPUs", [](M& m) { m.isolated_cpus.reset(); }, unknown, "unknown");
}

TEST(RealtimeMachine, AnEmptyMachineIsUnknownThroughout) {
  for (const RealtimeSetting& setting : assess({})) {
    EXPECT_EQ(setting.verdict, Verdict::unknown) << setting.name;
    EXPECT_FALSE(setting.reason.empty());
    EXPECT_FALSE(setting.remedy.empty());
  }
}

TEST(RealtimeMachine, FilesAreReadFromWhereTheyAre) {
  const maploop::testing::TemporaryFolder root;
  const auto put = [&](const std::string& name, const std::string& text) {
    const std::filesystem::path file = root.path() / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  };
  put("proc/version", "Linux version 6 PREEMPT_RT\n");
  put("proc/sys/kernel/sched_rt_runtime_us", "-1\n");
  put("sys/devices/system/cpu/online", "0-1\n");
  put("sys/devices/system/cpu/isolated", "\n");
  put("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "powersave\n");
  put("sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc\n");
  put("proc/irq/24/effective_affinity_list", "0-1\n");
  put("proc/irq/default_smp_affinity", "3\n");
  const MachineText machine = read_machine(root.path());
  EXPECT_EQ(machine.version, "Linux version 6 PREEMPT_RT");
  EXPECT_EQ(machine.rt_runtime_us, "-1");
  EXPECT_EQ(machine.isolated_cpus, "");
  EXPECT_FALSE(machine.realtime.has_value());
  ASSERT_EQ(machine.governors.size(), 1u);
  EXPECT_EQ(machine.governors[0].first, 1);
  EXPECT_EQ(machine.governors[0].second, "powersave");
  EXPECT_EQ(machine.clock_source, "tsc");
  EXPECT_EQ(machine.interrupts, (std::vector<std::pair<int, std::string>>{{24, "0-1"}}));
}

TEST(RealtimeMachine, ThisMachineIsReadable) {
  const MachineText machine = read_machine();
  EXPECT_TRUE(machine.version.has_value());
  EXPECT_NE(item(machine, "kernel").verdict, Verdict::unknown);
}

TEST(RealtimePrivileges, CapabilitiesAreReadFromTheStatus) {
  Privileges privileges;
  parse_capabilities("Name:\tmaploop\nCapEff:\t0000000000800000\n", privileges);
  EXPECT_TRUE(privileges.sys_nice);
  EXPECT_FALSE(privileges.ipc_lock);
  parse_capabilities("CapEff:\t0000000000004000\n", privileges);
  EXPECT_FALSE(privileges.sys_nice);
  EXPECT_TRUE(privileges.ipc_lock);
  for (const char* text : {"", "CapEff", "CapEff:", "CapEff:\tzz", "CapPrm:\tffffffffffffffff"}) {
    privileges.sys_nice = privileges.ipc_lock = true;
    parse_capabilities(text, privileges);
    EXPECT_FALSE(privileges.sys_nice || privileges.ipc_lock) << text;
  }
}

TEST(RealtimeText, CpuListsAreReadAsTheKernelWritesThem) {
  EXPECT_EQ(parse_cpu_list("0-2,5,7-8"), (std::vector<int>{0, 1, 2, 5, 7, 8}));
  EXPECT_EQ(parse_cpu_list("3\n"), std::vector<int>{3});
  EXPECT_EQ(parse_cpu_list(""), std::vector<int>{});
  for (const char* wrong : {"-1", "1-", "2-1", "1,", "a", "1;2", "0-99999999", "0x3"}) {
    EXPECT_FALSE(parse_cpu_list(wrong).has_value()) << wrong;
  }
  EXPECT_EQ(to_cpu_list({0, 1, 2, 5, 7, 8}), "0-2,5,7-8");
  EXPECT_EQ(to_cpu_list({}), "");
}

TEST(RealtimeText, ALineIsFoundByItsWholeKey) {
  constexpr std::string_view status_text = "VmLckX:\t 1 kB\nVmLck:\t  12 kB\nVmSize\t: 3 kB";
  EXPECT_EQ(line_value(status_text, "VmLck"), "12 kB");
  EXPECT_EQ(line_value(status_text, "VmSize"), "3 kB");
  EXPECT_FALSE(line_value(status_text, "VmRSS").has_value());
  EXPECT_FALSE(line_value("", "VmRSS").has_value());
}

TEST(RealtimeReport, TheTextIsOneItemAParagraph) {
  const RealtimeReport report{
      {{"fusion: scheduling", "fifo 60", "fifo 60", Verdict::granted, "", ""},
       {"heap", "64 MB", "0 MB", Verdict::refused, "no room", "make some"}}};
  EXPECT_EQ(to_text(report),
            "granted   fusion: scheduling  fifo 60\n"
            "refused   heap                0 MB (wanted: 64 MB)\n"
            "          why: no room\n"
            "          remedy: make some\n");
  EXPECT_FALSE(report.all_granted());
  EXPECT_EQ(report.find("heap")->granted, "0 MB");
  EXPECT_EQ(report.find("none"), nullptr);
}

}  // namespace
}  // namespace maploop::runtime
