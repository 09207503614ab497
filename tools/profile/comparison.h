// This file compares two profiles: of two machines, or of one before and after a change.
#pragma once

#include <string>
#include <vector>

#include "tools/profile/profile.h"

namespace maploop::profile {

// A figure of both runs; not finite where a run lacks it.
struct BothRuns {
  double a = 0.0, b = 0.0;
  double ratio() const { return b / a; }
};

// States how long a thread, a path, or a part of a thread took in both runs.
struct Compared {
  std::string name;
  BothRuns p50, p99;  // ms
  BothRuns missed;    // % of all
};

struct ComparedGroup {
  std::string title;
  std::vector<Compared> items;
};

struct Comparison {
  std::string a, b;  // names of the runs
  std::vector<ComparedGroup> groups;
  std::vector<Compared> processor;  // p50: s of the whole run; the others are not finite
};

// Both runs should be of one recording: nothing else makes their figures comparable.
Comparison compare(const std::string& name_a, const Profile& a, const std::string& name_b,
                   const Profile& b);

// Return tables for a terminal, and the same as JSON and as one self-contained HTML page.
std::string to_text(const Comparison& comparison);
std::string to_json(const Comparison& comparison);
std::string to_html(const Comparison& comparison);

}  // namespace maploop::profile
