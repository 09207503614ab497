// This file defines what the map feeds back to the filter whose states are matched.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "msgs/local_frame.h"
#include "msgs/named_enum.h"
#include "msgs/sample.h"

namespace maploop {

// States why nothing is fed back: the first reason that applies.
enum class FeedbackReason : std::uint8_t {
  none,             // feedback is given
  no_fix,           // the fix could not be matched
  off_road,         // the vehicle is not on a road of the map
  not_established,  // initial matching is not complete
  link_changed,     // the link changed with this fix
  too_slow,         // azimuths are meaningless
  azimuth_differs,  // the azimuth differs from the link's
  turning,          // the vehicle turns differently from the link
  near_junction,    // nearer than the position's uncertainty
  link_doubtful,    // P(link) is too small
  ambiguous,        // another link is nearly as likely, or as near
  inconsistent,     // recent offsets are larger than the fixes' sigmas allow
  not_yet,          // too close to the previous one to add information
};

constexpr auto names_of(FeedbackReason) {
  return names_up_to<FeedbackReason::not_yet>(
      {"fed back", "no usable fix", "off the road", "no link established yet", "link has changed",
       "too slow", "azimuth differs from the link's", "turning", "near a junction", "link doubtful",
       "another link is possible", "offsets contradict the fixes", "too close to the one before"});
}

// Describes the line of the road at the matched point: the vehicle is on it, except for its lane
// and the map's error. `stamp` is the fix's.
struct MapFeedback : Sample {
  FeedbackReason reason = FeedbackReason::no_fix;  // none: there is feedback
  bool position = false;                           // the line is fed back
  bool azimuth = false;                            // its direction is fed back
  bool reset = false;       // hard reset: position and azimuth become the matched ones
  bool new_road = false;    // the first on a road other than the previous one: another lane offset
  bool off_ground = false;  // the matched road is a bridge, in a tunnel or on another level

  Geodetic point;              // beside the matched point, in the lane; its height is unused
  double link_azimuth = 0.0;   // rad, as driven
  double cross_track = 0.0;    // m, of the fix, to the right of `point`
  double cross_sigma = 0.0;    // m, the part that changes from one feedback to the next
  double lane_sigma = 0.0;     // m, lane and map error, which persist along the road
  double azimuth_sigma = 0.0;  // rad
  double probability = 0.0;    // P(link)

  void archive(auto& ar) {
    ar(static_cast<Sample&>(*this), reason, position, azimuth, reset, new_road, off_ground, point,
       link_azimuth, cross_track, cross_sigma, lane_sigma, azimuth_sigma, probability);
  }
};

// Returns the unit vector (east, north) to the right of the line.
inline Eigen::Vector2d right_of_line(const MapFeedback& f) {
  return {std::cos(f.link_azimuth), -std::sin(f.link_azimuth)};
}

// Returns whether a filter that is fed back to learns anything from it.
inline bool says_something(const MapFeedback& f) {
  return f.position || f.azimuth || f.reason == FeedbackReason::inconsistent;
}

// Returns whether all values that a filter uses are finite.
inline bool all_finite(const MapFeedback& f) {
  for (const double value : {f.point.latitude, f.point.longitude, f.point.height, f.link_azimuth,
                             f.cross_sigma, f.lane_sigma, f.azimuth_sigma, f.probability}) {
    if (!std::isfinite(value)) return false;
  }
  return true;
}

// Returns whether the values fed back have valid standard deviations.
inline bool has_sigmas(const MapFeedback& f) {
  return (!f.position || (f.cross_sigma > 0.0 && f.lane_sigma >= 0.0)) &&
         (!f.azimuth || f.azimuth_sigma > 0.0);
}

}  // namespace maploop
