#include "runtime/vehicle/config/scheduling_config.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>

#include "msgs/named_enum.h"
#include "runtime/core/number_text.h"

namespace maploop::vehicle {
namespace {

using runtime::Scheduling;
using runtime::SchedulingPolicy;

bool has_priority(SchedulingPolicy policy) {
  return policy == SchedulingPolicy::fifo || policy == SchedulingPolicy::rr;
}

// Resets the values that do not go with the policy.
void forget_other_policies(Scheduling& s) {
  if (!has_priority(s.policy)) s.priority = 0;
  if (s.policy != SchedulingPolicy::other) {
    s.nice.reset();
    s.timer_slack = {};
  }
  if (s.policy != SchedulingPolicy::deadline) s.runtime = s.deadline = s.period = {};
}

void read_priority(const runtime::ConfigTable& table, Scheduling& s) {
  table.read_in("priority", s.priority, 1, 99);
  if (s.priority == 0) {
    table.fail("policy", "needs a priority from 1 to 99; a higher one runs first");
  }
}

void read_other(const runtime::ConfigTable& table, Scheduling& s) {
  if (table.has("nice")) table.read_in("nice", s.nice.emplace(0), -20, 19);
  table.read_in("timer_slack_us", s.timer_slack, Duration::zero(), std::chrono::seconds(2));
}

void read_deadline(const runtime::ConfigTable& table, Scheduling& s) {
  table.read("runtime_ms", s.runtime);
  table.read("deadline_ms", s.deadline);
  table.read("period_ms", s.period);
  if (s.runtime < Duration(1024) || s.runtime > s.deadline || s.deadline > s.period) {
    table.fail("policy", "needs 0.001024 <= runtime_ms <= deadline_ms <= period_ms");
  }
}

void refuse(const runtime::ConfigTable& table, std::initializer_list<const char*> keys,
            SchedulingPolicy policy, std::string_view of) {
  for (const char* key : keys) {
    if (!table.has(key)) continue;
    table.fail(key, fmt::format("can only be used with policy {}, not with \"{}\"", of,
                                to_string(policy)));
  }
}

}  // namespace

std::span<const ScheduledThread> scheduled_threads() {
  using P = SchedulingParameters;
  static constexpr std::string_view driver = "Driver: it only sleeps and hands over.";
  static constexpr auto threads = std::to_array<ScheduledThread>({
      {"camera", &P::camera, driver},
      {"velodyne", &P::velodyne, driver},
      {"imu", &P::imu, driver},
      {"gnss", &P::gnss, driver},
      {"wheel", &P::wheel, driver},
      {"reference", &P::reference, driver},
      {"odometry", &P::odometry, driver},
      {"stereo", &P::stereo, "Below fusion. Its work is bounded: an eighth of one core at 10 Hz."},
      {"lidar", &P::lidar, "Below stereo, whose motions it waits for."},
      {"ppp", &P::ppp, "Below fusion, whose ticks are shorter."},
      {"fusion", &P::fusion, "Below the drivers, whose samples it needs."},
      {"mapmatch", &P::mapmatch, "Below fusion, whose states it needs; a tick takes 10 us."},
      {"publisher", &P::publisher, "Messages to the bus and to the log."},
      {"health", &P::health, "State of the threads, once per second."},
      {"snapshot", &P::snapshot, "Snapshots of a replay."},
      {"preview", &P::preview, "Only where no other thread has work."},
  });
  return threads;
}

void read(const runtime::ConfigTable& parent, const char* key, Scheduling& s) {
  const runtime::ConfigTable table = parent.table(key);
  std::string policy(to_string(s.policy));
  table.read_one_of("policy", policy, names_of(s.policy));
  s.policy = *value_named<SchedulingPolicy>(policy);
  forget_other_policies(s);
  if (has_priority(s.policy)) {
    read_priority(table, s);
  } else {
    refuse(table, {"priority"}, s.policy, "\"fifo\" and \"rr\"");
  }
  if (s.policy == SchedulingPolicy::other) {
    read_other(table, s);
  } else {
    refuse(table, {"nice", "timer_slack_us"}, s.policy, "\"other\"");
  }
  if (s.policy == SchedulingPolicy::deadline) {
    read_deadline(table, s);
  } else {
    refuse(table, {"runtime_ms", "deadline_ms", "period_ms"}, s.policy, "\"deadline\"");
  }
  table.read_in("cpus", s.cpus, 0, 1023);
  if (s.policy == SchedulingPolicy::deadline && !s.cpus.empty()) {
    table.fail(
        "cpus",
        "must be empty with policy \"deadline\": the kernel does not bind such threads to CPUs");
  }
  table.read_in("prefaulted_stack_kb", s.prefaulted_stack_kb, 0, 1 << 20);
}

std::string toml_value(const Scheduling& s) {
  const auto scaled = [](Duration d, double unit) {
    return runtime::shortest_text(static_cast<double>(d.count()) * unit);
  };
  std::string text = fmt::format("{{ policy = \"{}\"", to_string(s.policy));
  if (has_priority(s.policy)) text += fmt::format(", priority = {}", s.priority);
  if (s.nice) text += fmt::format(", nice = {}", *s.nice);
  if (s.timer_slack > Duration::zero()) text += ", timer_slack_us = " + scaled(s.timer_slack, 1e-3);
  text +=
      s.policy == SchedulingPolicy::deadline
          ? fmt::format(", runtime_ms = {}, deadline_ms = {}, period_ms = {}",
                        scaled(s.runtime, 1e-6), scaled(s.deadline, 1e-6), scaled(s.period, 1e-6))
          : fmt::format(", cpus = [{}]", fmt::join(s.cpus, ", "));
  return fmt::format("{}, prefaulted_stack_kb = {} }}", text, s.prefaulted_stack_kb);
}

const runtime::Scheduling* find_scheduling(const SchedulingParameters& parameters,
                                           const StageSpec& stage) {
  const std::string_view key = stage.scheduled_as.empty() ? stage.name : stage.scheduled_as;
  for (const ScheduledThread& thread : scheduled_threads()) {
    if (thread.key == key) return &(parameters.*thread.scheduling);
  }
  return nullptr;
}

const runtime::Scheduling& scheduling_of(const SchedulingParameters& parameters,
                                         const StageSpec& stage) {
  if (const runtime::Scheduling* found = find_scheduling(parameters, stage)) return *found;
  throw std::logic_error("[scheduling] has no key for '" + std::string(stage.name) + "'");
}

}  // namespace maploop::vehicle
