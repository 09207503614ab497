// This file computes when the steps of threads with fixed priorities end at the latest, on a number
// of CPUs.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace maploop::analyze {

// A thread that is released again and again; times are in ms.
struct Task {
  std::string name;
  int priority = 0;        // higher goes first
  std::vector<int> cpus;   // where it may run; empty: on all
  double period = 0.0;     // least time between two releases
  double execution = 0.0;  // of one step at most
  // Threads whose results release it: it may be released as late as they end.
  std::vector<std::size_t> after;
};

// Returns for each task the time from release to result that no step exceeds; infinite where tasks
// of higher priority leave it no such time. `blocking` (ms) is what the kernel may hold up any
// step.
//
// A task waits while all CPUs on which it may run are taken by tasks of the same or a higher
// priority: R = blocking + C + sum of min(W(R), R - C) / CPUs, where W(R) is the work that such a
// task can bring into a time R (Bertogna and Cirinei, RTSS 2007); on one CPU this is the
// response-time analysis of Joseph and Pandya (1986).
std::vector<double> response_times(const std::vector<Task>& tasks, int cpus, double blocking);

}  // namespace maploop::analyze
