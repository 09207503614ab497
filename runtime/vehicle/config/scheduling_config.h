// This file states how the kernel is to schedule each thread of the graph. In the configuration
// this is:
//
//   [scheduling.fusion]
//   policy = "fifo"           # inherited, other, fifo, rr or deadline
//   priority = 60             # with fifo and rr: 1 to 99, higher goes first
//   nice = 0                  # with other: -20 to 19, lower gets a larger share
//   timer_slack_us = 50       # with other: how late the thread may be woken
//   runtime_ms = 1            # with deadline: CPU time within deadline_ms of each period_ms
//   deadline_ms = 2
//   period_ms = 10
//   cpus = [0, 1]             # where the thread may run; empty: anywhere. Not with deadline.
//   prefaulted_stack_kb = 256 # stack that is mapped before the thread starts its work
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "runtime/core/config.h"
#include "runtime/core/realtime_scheduling.h"
#include "runtime/vehicle/graph/stage_specs.h"

namespace maploop::vehicle {

// Returns fifo with a stack that covers what the stages call.
inline runtime::Scheduling realtime(int priority) {
  runtime::Scheduling scheduling = runtime::Scheduling::fifo(priority);
  scheduling.prefaulted_stack_kb = 256;
  return scheduling;
}

// Returns the default policy with the smallest of the kernel's fair shares.
inline runtime::Scheduling yielding() {
  runtime::Scheduling scheduling;
  scheduling.policy = runtime::SchedulingPolicy::other;
  scheduling.nice = 19;
  return scheduling;
}

// These are applied if the clock is paced; on virtual time no thread has to be punctual.
// scheduled_threads() gives the reasons for the defaults.
struct SchedulingParameters {
  runtime::Scheduling camera = realtime(70);
  runtime::Scheduling velodyne = realtime(70);
  runtime::Scheduling imu = realtime(70);
  runtime::Scheduling gnss = realtime(70);
  runtime::Scheduling wheel = realtime(70);
  runtime::Scheduling reference = realtime(70);
  runtime::Scheduling odometry = realtime(70);
  runtime::Scheduling stereo = realtime(40);
  runtime::Scheduling lidar = realtime(30);
  runtime::Scheduling ppp = realtime(50);
  runtime::Scheduling fusion = realtime(60);
  runtime::Scheduling mapmatch = realtime(50);
  runtime::Scheduling publisher;
  runtime::Scheduling health;
  runtime::Scheduling snapshot;
  runtime::Scheduling preview = yielding();
};

// This is a key of [scheduling].
struct ScheduledThread {
  const char* key;
  runtime::Scheduling SchedulingParameters::*scheduling;
  std::string_view meaning;
};
std::span<const ScheduledThread> scheduled_threads();

// Returns the scheduling of a thread of the graph; nullptr if [scheduling] does not have it.
const runtime::Scheduling* find_scheduling(const SchedulingParameters& parameters,
                                           const StageSpec& stage);

// Returns the same of a thread that it has.
const runtime::Scheduling& scheduling_of(const SchedulingParameters& parameters,
                                         const StageSpec& stage);

// Reads the table `key`. A missing key leaves its value as it is, but values that belong to another
// policy are reset. Throws runtime::ConfigError, also for a key that does not go with the policy.
void read(const runtime::ConfigTable& parent, const char* key, runtime::Scheduling& scheduling);

// Returns an inline table with the keys that go with the policy.
std::string toml_value(const runtime::Scheduling& scheduling);

}  // namespace maploop::vehicle
