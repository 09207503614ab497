// The matcher on the fused state.
#pragma once

#include "mapmatch/matcher.h"
#include "mapmatch/visual_course.h"
#include "msgs/archive.h"
#include "msgs/map_match.h"
#include "msgs/nav_state.h"

namespace maploop::mapmatch {

// What of a state matters to the matcher: position, speed and azimuth of the body, with what the
// state's covariance says of them.
VehicleFix fix_of(const NavState& state);

// Not thread-safe; allocates nothing after construction. Decides by the states and their stamps
// alone.
class NavMatcher {
 public:
  // The network and the rules must outlive it.
  NavMatcher(const RoadNetwork& network, const RuleBases& rules, const MatchParameters& parameters)
      : matcher_(network, rules, parameters) {}

  // Visual odometry in the order of its stamps: for the rules that ask for it.
  void add(const RelativeMotion& visual) { course_.add(visual); }

  // States in the order of their stamps. Of one that cannot be used, `refusal` says why, and there
  // is no link. `available` and `sequence` are the caller's. Valid until the next call.
  MapMatch& add(const NavState& state);

  const RoadNetwork& network() const { return matcher_.network(); }
  const RuleBases& rules() const { return matcher_.rules(); }

  // The whole state; loading refuses another network or other parameters.
  template <class Archive>
  void archive(Archive& ar) {
    ar(matcher_, course_);
  }

 private:
  void describe_place(const NavState& state, const LinkPoint& point);

  Matcher matcher_;
  VisualCourse course_;
  MapMatch match_;
};

}  // namespace maploop::mapmatch
