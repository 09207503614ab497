// Where the vehicle was when the last run ended, and what that says at the next start.
#pragma once

#include <cstdint>

#include "estimators/fusion/initial_state.h"
#include "msgs/named_enum.h"

namespace maploop::fusion {

// Holds a pose from the end of a run, each standard deviation on its axis.
struct LastPlace {
  Time stamp{};                                              // of all values
  Geodetic position;                                         // of the body's origin
  Attitude attitude;                                         // of the body
  double speed = 0.0;                                        // m/s over ground, negative in reverse
  Eigen::Vector3d position_sigma = Eigen::Vector3d::Zero();  // m, east, north, up
  double azimuth_sigma = 0.0;                                // rad
  double tilt_sigma = 0.0;                                   // rad, pitch and roll
  double speed_sigma = 0.0;                                  // m/s
  // As in KnownStart. Without it the filter would take the next fixes, whose error is still the
  // same, for independent ones.
  Eigen::Vector3d fix_offset = Eigen::Vector3d::Zero();              // o, east, north, up
  Eigen::Vector3d fix_offset_sigma = Eigen::Vector3d::Ones();        // of o; 1: o is not known
  Eigen::Vector3d fix_offset_correlation = Eigen::Vector3d::Zero();  // -1 to 1

  // Forgets that: the next fixes are from another receiver or filter.
  void forget_fixes() {
    fix_offset = fix_offset_correlation = Eigen::Vector3d::Zero();
    fix_offset_sigma = Eigen::Vector3d::Ones();
  }
};

template <class Archive>
void archive(Archive& ar, LastPlace& p) {
  ar(p.stamp, p.position, p.attitude, p.speed, p.position_sigma, p.azimuth_sigma, p.tilt_sigma,
     p.speed_sigma, p.fix_offset, p.fix_offset_sigma, p.fix_offset_correlation);
}

// Returns the place that the state says. `frame` is that of the state.
LastPlace last_place(const FilterState& state, const LocalFrame& frame);

// What a filter has done with the last place. The filter moves on from `remembered` at its first
// measurement, and from `started` by fixes.
enum class PlaceUse : std::uint8_t {
  none,           // no place is known
  remembered,     // no measurement has come yet
  started,        // the filter started there; no fix has been compared with it
  seen,           // a fix has agreed with the position
  confirmed,      // a fix of the moving vehicle has agreed with position and course
  from_future,    // another clock has stamped it; from here on: why it is not used
  too_old,        // by more than max_gap if the vehicle drove, by a year if it stood
  too_uncertain,  // or implausible
  moved,          // a fix or a speed contradicts it
};

constexpr auto names_of(PlaceUse) {
  return names_up_to<PlaceUse::moved>(
      {"no last place is known", "the last place waits for the first sample",
       "started at the last place", "a fix has agreed with the last place",
       "fixes have agreed with the last place and azimuth",
       "the last place is from the future: another clock has stamped it",
       "the last place is too old", "the last place is too uncertain or implausible",
       "the car is not where it was left"});
}

// Whether a place was known and is not used.
constexpr bool dropped(PlaceUse use) {
  return use >= PlaceUse::from_future;
}

// Returns a start at the place's own stamp.
KnownStart known_start(const LastPlace& place);

// Says how a filter starts at the last place, or why it does not.
struct PlaceStart {
  PlaceUse use = PlaceUse::none;  // started, or why the place is not used
  KnownStart start;               // if `use` is `started`
};

// Returns how a filter starts whose first measurement has the stamp `first`. A vehicle that stood
// is where it was, and is less certain for having been away. A vehicle that drove starts at its own
// stamp, and the filter carries it on as one whose inertial unit is silent, (5) to (7) of
// METHOD.md; beyond `max_gap` this says nothing of its azimuth.
PlaceStart start_at(const LastPlace& place, Time first, const FusionParameters& parameters);

}  // namespace maploop::fusion
