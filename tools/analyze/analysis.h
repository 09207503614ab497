// This file computes which deadlines of the vehicle's threads can be promised beforehand, from one
// measured run.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "runtime/vehicle/config/vehicle_config.h"
#include "tools/analyze/execution_bound.h"
#include "tools/profile/profile.h"

namespace maploop::analyze {

// States what can be promised of one thread. Times are in ms, and NaN where they are not known.
struct Promise {
  std::string name;
  std::string scheduling;  // as configured: "fifo 60"
  double period = 0.0;     // of a fixed rate, else the mean of the run
  ExecutionBound execution;
  double response = 0.0;  // from release to result at most, by analysis
  double measured = 0.0;  // the longest of the run
  double deadline = 0.0;  // 0: none
  bool kept() const { return deadline == 0.0 || response <= deadline; }
};

struct Analysis {
  int cpus = 0;
  double blocking = 0.0;            // ms, the longest wake-up of the run
  double utilization = 0.0;         // of all CPUs, by real-time threads
  std::vector<Promise> threads;     // those that go before others, the highest priority first
  std::vector<std::string> advice;  // a sentence for each promise that cannot be given
};

struct AnalysisParameters {
  int cpus = 0;
  BoundParameters execution;
};

// Throws std::invalid_argument if the run was on virtual time: its threads did not wait for times.
Analysis analyze(const profile::Profile& profile, const vehicle::SchedulingParameters& scheduling,
                 const AnalysisParameters& parameters);

std::string to_text(const Analysis& analysis);
nlohmann::json to_json(const Analysis& analysis);

}  // namespace maploop::analyze
