// This class applies the matcher to the fused state.
#pragma once

#include "mapmatch/matcher.h"
#include "mapmatch/visual_course.h"
#include "msgs/archive.h"
#include "msgs/map_match.h"
#include "msgs/nav_state.h"

namespace maploop::mapmatch {

// Returns whether a state has a position and a course, without which it cannot be matched.
bool has_position(const NavState& state);

// Returns the part of a state that the matcher uses: position, speed and azimuth of the body with
// their standard deviations from the state's covariance.
VehicleFix fix_of(const NavState& state);

// Not thread-safe; allocates nothing after construction. Decisions depend only on the states, the
// visual motions and their stamps.
class NavMatcher {
 public:
  // The network and the rules must outlive this object.
  NavMatcher(const RoadNetwork& network, const RuleBases& rules, const MatchParameters& parameters)
      : matcher_(network, rules, parameters) {}

  // Takes visual odometry in the order of its stamps, for the rules that use it.
  void add(const RelativeMotion& visual) { course_.add(visual); }

  // Takes over the visual odometry that another matcher has taken, which is the same on all roads.
  void take_course(const NavMatcher& before) { course_ = before.course_; }

  // Takes states in the order of their stamps. If a state cannot be used, `refusal` states why and
  // the result has no link. The caller sets `available` and `sequence`. The result is valid until
  // the next call.
  MapMatch& add(const NavState& state);

  // Returns the network that was given to the constructor.
  const RoadNetwork& network() const { return matcher_.network(); }
  // Returns the rules that were given to the constructor.
  const RuleBases& rules() const { return matcher_.rules(); }

  // Archives the whole state. Loading refuses an archive of another network or other parameters.
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
