// A table of methods that ran on the same frames, for the terminal and for a page.
#pragma once

#include <string>
#include <vector>

#include "tools/evaluate/evaluation.h"
#include "tools/web/page.h"
#include "tools/web/table.h"

namespace maploop::odometry {

struct Compared {
  web::Row cells;  // the method's name first
  evaluation::Evaluation score;
};

struct Comparison {
  web::Row heading;
  std::string notes;
  std::vector<Compared> methods = {};
};

// Scores segments of 25 m, for drives that have hardly any of the other length, and of 100 m; poses
// match whose stamps differ by at most 1 ms.
evaluation::Evaluation scored(const evaluation::StampedTrajectory& estimate,
                              const evaluation::StampedTrajectory& truth);

// Return cells with "-" if there is no segment.
std::string percent_cell(const evaluation::SegmentError& error);
std::string turning_cell(const evaluation::SegmentError& error);

std::string to_text(const Comparison& comparison);
// Returns a page with the table, the paths seen from above, and the errors along the way.
std::string to_html(const Comparison& comparison, const std::string& heading);

}  // namespace maploop::odometry
