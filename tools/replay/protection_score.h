// How often the fused position is beyond its protection levels, and how large these are.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "msgs/nav_protection.h"
#include "msgs/reference.h"
#include "tools/replay/fusion_score.h"

namespace maploop::fusion_score {

// The horizontal error of the fused position at one moment, beside its levels. The levels do not
// hold where an aid was doubted.
struct ProtectedMoment {
  struct Error {
    double size = 0.0;   // m
    double level = 0.0;  // m
    bool beyond() const { return size > level; }
    double ratio() const { return size / level; }
  };

  Time stamp;
  bool doubted = false;
  Error along, across, horizontal;
};

struct ProtectionScore {
  // This describes one level, over the moments in which no aid is doubted.
  struct Level {
    std::size_t beyond = 0;  // errors beyond it
    double median = 0.0;     // m
  };

  double risk = 0.0;  // that the levels are made for
  // There are ten a second, where the reference is good enough.
  std::vector<ProtectedMoment> moments;
  std::size_t doubted = 0;  // of these, in which an aid was doubted
  Level along, across, horizontal;
  double largest_ratio = 0.0;  // 1, of a horizontal error to its level, the same
  double below_5 = 0.0,
         below_10 = 0.0;  // 1, share of moments with a horizontal level below 5, 10 m that holds
};

// Returns nothing if there are no levels, or no reference for any. Moments before `from` are not
// scored.
std::optional<ProtectionScore> score(const std::vector<NavProtection>& levels,
                                     const NavTrack& track,
                                     const std::vector<ReferencePose>& reference, Time from);

// Some lines for a terminal.
std::string to_text(const ProtectionScore& score);

}  // namespace maploop::fusion_score
