// The outcome states whether a measurement was applied, held or refused, and why.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace maploop::fusion {

// States what the filter does with a measurement.
enum class Disposition : std::uint8_t {
  applied,  // used by the filter
  held,     // kept until the filter starts, then applied
  refused,  // `reason` states why
};

// States why a measurement is refused.
enum class Reason : std::uint8_t {
  none,  // not refused
  // These refuse a measurement on arrival; it is discarded.
  not_finite,          // a value is infinite or not a number
  out_of_range,        // beyond what the sensor or a road vehicle can do
  invalid_covariance,  // not symmetric, or a negative variance
  bad_interval,        // odometry over an empty, reversed or too long interval
  duplicate,           // stamp and sequence equal those of a known measurement
  too_old,             // older than the history
  before_start,        // before the time at which the filter started
  after_delivery,      // stamped later than delivered: the sensor's clock is wrong
  clock_fell_back,     // the sensor's clock went back and is not right again yet
  frozen,              // stuck: bit for bit equal for too long while moving (refused at its stamp)
  time_jump,           // too far ahead of all others, or not confirmed by a second stamp
  // These refuse odometry at its stamp: it does not correct, but the next interval starts there.
  odometry_not_ok,   // its own status reports a failure (bad input: refused on arrival)
  interval_unknown,  // the filter does not know the attitude at the interval's start
  speed_gate,        // forward speed contradicts the prediction
  rotation_gate,     // rotation contradicts the prediction
  implausible_tilt,  // the correction would tilt the vehicle too far
  wheel_gate,        // the wheels' speed contradicts the prediction
  wheels_wrong,      // fixes have shown for seconds that it is not the vehicle's speed
  not_configured,    // the configuration does not use this sensor (refused on arrival)
  // These refuse GNSS fixes.
  position_gate,        // position contradicts the prediction
  velocity_gate,        // velocity contradicts the prediction
  already_started,      // the configuration uses fixes only to start
  no_course,            // of a slow or an uncertain velocity; the filter waits for a better one
  stamps_apart,         // position and velocity are too far apart in time
  too_far_from_origin,  // a start farther away than max_origin_distance
  // These refuse map feedback.
  nothing_fed_back,   // the feedback itself contains the reason
  map_not_trusted,    // the map misled the filter shortly before
  line_gate,          // the road's line contradicts the prediction
  link_azimuth_gate,  // the road's azimuth contradicts the prediction
};

// Number of reasons, with `none`; the size of counters by Reason.
constexpr std::size_t reason_count = static_cast<std::size_t>(Reason::link_azimuth_gate) + 1;

// States what became of a measurement.
struct Outcome {
  Disposition disposition = Disposition::applied;  // what the filter does with the measurement
  Reason reason = Reason::none;                    // why it is refused

  bool refused() const { return disposition == Disposition::refused; }  // whether it is not used
  bool operator==(const Outcome&) const = default;  // same disposition and reason
};

template <class Archive>
void archive(Archive& ar, Outcome& o) {
  ar(o.disposition, o.reason);
}

// Returns the outcome of a measurement that is refused for `reason`.
constexpr Outcome refused(Reason reason) {
  return {Disposition::refused, reason};
}

// Returns a phrase for reports. It is a literal, so its data() ends with a null.
constexpr std::string_view to_string(Disposition disposition) {
  switch (disposition) {
    case Disposition::applied:
      return "applied";
    case Disposition::held:
      return "held until the filter starts";
    case Disposition::refused:
      return "refused";
  }
  return "unknown";
}

// The same of a reason.
constexpr std::string_view to_string(Reason reason) {
  switch (reason) {
    case Reason::none:
      return "none";
    case Reason::not_finite:
      return "a value is not finite";
    case Reason::out_of_range:
      return "a value is out of range";
    case Reason::invalid_covariance:
      return "invalid covariance";
    case Reason::bad_interval:
      return "bad odometry interval";
    case Reason::duplicate:
      return "duplicate";
    case Reason::too_old:
      return "older than the history";
    case Reason::before_start:
      return "before the filter's start";
    case Reason::after_delivery:
      return "stamped later than delivered";
    case Reason::clock_fell_back:
      return "the sensor's clock has fallen back";
    case Reason::frozen:
      return "the sensor is stuck at one value";
    case Reason::time_jump:
      return "jump of the time stamp";
    case Reason::odometry_not_ok:
      return "odometry reports a failure";
    case Reason::interval_unknown:
      return "start of the odometry interval unknown";
    case Reason::speed_gate:
      return "speed contradicts the prediction";
    case Reason::rotation_gate:
      return "rotation contradicts the prediction";
    case Reason::implausible_tilt:
      return "implausible tilt";
    case Reason::wheel_gate:
      return "wheel speed contradicts the prediction";
    case Reason::wheels_wrong:
      return "fixes contradict the wheel speed (unit, sign or scale?)";
    case Reason::not_configured:
      return "not used by the configuration";
    case Reason::position_gate:
      return "GNSS position contradicts the prediction";
    case Reason::velocity_gate:
      return "GNSS velocity contradicts the prediction";
    case Reason::already_started:
      return "GNSS after the start (GNSS+ in the configuration uses it)";
    case Reason::no_course:
      return "too slow or too uncertain for a course";
    case Reason::stamps_apart:
      return "position and velocity too far apart in time";
    case Reason::too_far_from_origin:
      return "too far from the origin";
    case Reason::nothing_fed_back:
      return "the map feeds nothing back";
    case Reason::map_not_trusted:
      return "the map has led astray a moment ago";
    case Reason::line_gate:
      return "road contradicts the predicted position";
    case Reason::link_azimuth_gate:
      return "road contradicts the predicted azimuth";
  }
  return "unknown";
}

}  // namespace maploop::fusion
