// A match history judges each fix by later ones, too: after a lag, or at the end of the drive.
#pragma once

#include <cstdint>
#include <vector>

#include "mapmatch/matcher.h"

namespace maploop::mapmatch {

// Remembers for each fix the path hypotheses behind it, and which of the fix before each continues.
// Takes 6 kB a fix. Not thread-safe.
class MatchHistory {
 public:
  // The network must outlive this object.
  explicit MatchHistory(const RoadNetwork& network) : network_(&network) {}

  // Takes the result of each fix with its matcher, in the order of the fixes.
  void add(const MatchResult& result, const Matcher& matcher);

  // Returns the results of all fixes, each judged by the fixes until `lag` after it: (19) and (20)
  // of METHOD.md. Fixes that were refused, and all if the matcher has no paths, are as they were.
  std::vector<MatchResult> judged_after(Duration lag) const;

 private:
  // A hypothesis after a fix.
  struct Path {
    DirectedLink link;
    double along = 0.0;    // m from where the link is entered
    double share = 0.0;    // of the evidence until this fix
    double mapped = 0.0;   // P that it is a road of the map, given that it is the path
    std::uint32_t parent;  // index among those of the fix before
  };
  // The hypotheses after a fix that was used.
  struct Moment {
    std::size_t result = 0;                 // index in results_
    std::size_t first_path = 0, count = 0;  // in paths_
  };
  using Weights = std::vector<double>;  // of the paths of a moment, by all fixes until a later one

  Weights shares(const Moment& moment) const;
  Weights before(const Moment& moment, const Weights& weights, const Moment& earlier) const;
  double off_road(std::size_t moment, std::size_t last) const;
  MatchResult judged(const Moment& moment, const Weights& weights, double off_road) const;

  const RoadNetwork* network_;
  std::vector<MatchResult> results_;
  std::vector<Moment> moments_;
  std::vector<Path> paths_;
};

}  // namespace maploop::mapmatch
