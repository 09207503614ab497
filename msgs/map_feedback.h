// What the map gives back to the filter that the map matching got its fixes from.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "msgs/local_frame.h"
#include "msgs/sample.h"

namespace maploop {

// Why nothing is fed back, the first that applies.
enum class FeedbackReason : std::uint8_t {
  none,             // fed back
  no_fix,           // the fix could not be matched
  off_road,         // on no road of the map
  not_established,  // initial matching goes on
  link_changed,     // on another link since this fix
  too_slow,         // azimuths mean nothing
  azimuth_differs,  // from the link's
  turning,          // otherwise than the link does
  near_junction,    // closer than the position is known
  link_doubtful,    // P(link) is too small
  ambiguous,        // another link is nearly as likely, or as near
  inconsistent,     // the last offsets were too large for what the fixes say of themselves
  not_yet,          // too close to the one before to say anything new
};

constexpr std::size_t feedback_reason_count = static_cast<std::size_t>(FeedbackReason::not_yet) + 1;

constexpr std::string_view to_string(FeedbackReason reason) {
  switch (reason) {
    case FeedbackReason::none:
      return "fed back";
    case FeedbackReason::no_fix:
      return "no usable fix";
    case FeedbackReason::off_road:
      return "off the road";
    case FeedbackReason::not_established:
      return "no link established yet";
    case FeedbackReason::link_changed:
      return "link has changed";
    case FeedbackReason::too_slow:
      return "too slow";
    case FeedbackReason::azimuth_differs:
      return "azimuth differs from the link's";
    case FeedbackReason::turning:
      return "turning";
    case FeedbackReason::near_junction:
      return "near a junction";
    case FeedbackReason::link_doubtful:
      return "link doubtful";
    case FeedbackReason::ambiguous:
      return "another link is possible";
    case FeedbackReason::inconsistent:
      return "offsets contradict the fixes";
    case FeedbackReason::not_yet:
      return "too close to the one before";
  }
  return "unknown";
}

// The line of the road that the vehicle is on, at the matched point: the vehicle is on it, but for
// its lane and the map's error. `stamp` is the fix's.
struct MapFeedback : Sample {
  FeedbackReason reason = FeedbackReason::no_fix;
  bool position = false;  // the line is fed back
  bool azimuth = false;   // its direction is fed back
  bool reset = false;     // hard reset: position and azimuth become the matched ones
  bool new_road = false;  // the first on another road than the one before: another lane offset

  Geodetic point;              // beside the matched one, in the lane; its height means nothing
  double link_azimuth = 0.0;   // rad, as driven
  double cross_track = 0.0;    // m, of the fix, to the right of `point`
  double cross_sigma = 0.0;    // m, what changes from one feedback to the next
  double lane_sigma = 0.0;     // m, lane and map error, which stay along the road
  double azimuth_sigma = 0.0;  // rad
  double probability = 0.0;    // P(link)
};

template <class Archive>
void archive(Archive& ar, MapFeedback& f) {
  ar(static_cast<Sample&>(f), f.reason, f.position, f.azimuth, f.reset, f.new_road, f.point,
     f.link_azimuth, f.cross_track, f.cross_sigma, f.lane_sigma, f.azimuth_sigma, f.probability);
}

// East and north, unit, to the right of the line.
inline Eigen::Vector2d right_of_line(const MapFeedback& f) {
  return {std::cos(f.link_azimuth), -std::sin(f.link_azimuth)};
}

// Whether all that a filter computes with is a number.
inline bool all_finite(const MapFeedback& f) {
  for (const double value : {f.point.latitude, f.point.longitude, f.point.height, f.link_azimuth,
                             f.cross_sigma, f.lane_sigma, f.azimuth_sigma, f.probability}) {
    if (!std::isfinite(value)) return false;
  }
  return true;
}

// Whether what is fed back has standard deviations that can be.
inline bool has_sigmas(const MapFeedback& f) {
  return (!f.position || (f.cross_sigma > 0.0 && f.lane_sigma >= 0.0)) &&
         (!f.azimuth || f.azimuth_sigma > 0.0);
}

}  // namespace maploop
