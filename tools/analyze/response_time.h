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
  double blocking = 0.0;   // how long the kernel holds up one step at most
  // Threads whose results release it: it may be released as late as they end.
  std::vector<std::size_t> after;
};

// Returns for each task the time from release to result that no step exceeds; infinite where tasks
// of higher priority leave it no such time.
//
// A task waits for a time X while all n CPUs on which it may run are taken by tasks of the same or
// a higher priority: R = blocking + C + X. Each of these takes one CPU at a time, so X is at most
// the largest with n X <= sum of min(W(R), X): a long step on one of two CPUs delays nobody longer
// than the other CPU is taken. W(R) is the work that such a task can bring into a time R. On one
// CPU this is the response-time analysis of Joseph and Pandya (1986). On several, a step that was
// released before may still be running at the beginning, but none runs longer than its own response
// (Bertogna and Cirinei, RTSS 2007).
std::vector<double> response_times(const std::vector<Task>& tasks, int cpus);

}  // namespace maploop::analyze
