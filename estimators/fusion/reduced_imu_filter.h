// This extended Kalman filter combines two horizontal accelerometers, one vertical gyro and
// odometry, and applies late data at its own stamp.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>

#include "estimators/fusion/earth.h"
#include "estimators/fusion/event_history.h"
#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/initial_state.h"
#include "estimators/fusion/last_place.h"
#include "estimators/fusion/outcome.h"
#include "estimators/fusion/self_calibration.h"
#include "estimators/fusion/sensor_clock.h"
#include "estimators/fusion/stamp_guard.h"
#include "msgs/gnss.h"
#include "msgs/local_frame.h"
#include "msgs/map_feedback.h"
#include "msgs/odom_state.h"
#include "msgs/wheel_speed.h"

namespace maploop {
class ArchiveReader;
class ArchiveWriter;
}  // namespace maploop

namespace maploop::fusion {

// Says how far a filter has come.
enum class Phase : std::uint8_t {
  waiting_for_fix,     // no usable GNSS fix has arrived yet
  waiting_for_motion,  // the last fix was too slow to define a course
  running,             // the filter has started
};

// Says how far the filter has come, and counts what it has done.
struct FilterStatus {
  Phase phase = Phase::waiting_for_fix;  // what the filter waits for, if it has not started
  std::uint64_t recoveries = 0;         // inflations after gated measurements, since the last start
  std::uint64_t reinitializations = 0;  // restarts from a fix after gated ones, since then
  std::uint64_t restarts = 0;           // restarts after a jump of the data's clock
  std::uint64_t shortened = 0;          // events dropped early because the history was full
  std::uint64_t restorations = 0;       // times a map-free copy replaced the filter
  std::uint64_t unused = 0;             // held measurements that became too old before the start
  // These count all added measurements by their outcome on arrival. (A later arrival may change
  // what the filter does with a measurement; NavState counts those that a state includes.)
  std::uint64_t applied = 0;                          // on arrival
  std::uint64_t held = 0;                             // on arrival, as the filter had not started
  PlaceUse place = PlaceUse::none;                    // what was done with the last place (recall)
  std::array<std::uint64_t, reason_count> refused{};  // by Reason

  // Returns how many measurements were refused on arrival for `reason`.
  std::uint64_t refused_for(Reason reason) const {
    return refused[static_cast<std::size_t>(reason)];
  }
};

template <class Archive>
void archive(Archive& ar, FilterStatus& s) {
  ar(s.phase, s.recoveries, s.reinitializations, s.restarts, s.shortened, s.restorations, s.unused,
     s.applied, s.held, s.place, s.refused);
}

// Not thread-safe. Reads no clock, and allocates nothing after construction.
//
// Measurements may arrive in any order and late by up to `history_length`. Each is applied at its
// own stamp and everything after it is recomputed, so the result has the same bits as if all had
// arrived in the order of (stamp, kind, sequence). The inertial input is interpolated between
// samples; after the newest sample its value is held.
//
// Implausible stamps are refused. If the clock of all data has jumped, the filter restarts with an
// empty history in the same frame and waits for a fix (StampGuard). The status counts every
// measurement as applied, held or refused with its reason.
//
// Axes are the body's (x forward, y left, z up; msgs/frames.h). The body's origin is assumed to
// roll without side slip, as a point near the rear axle does.
class ReducedImuFilter {
 public:
  // Throws std::invalid_argument if a parameter is out of its bounds. Without an origin, the
  // position of the fix that starts the filter becomes the origin.
  explicit ReducedImuFilter(const FusionParameters& parameters,
                            std::optional<Geodetic> origin = std::nullopt);

  // Each add() returns what became of its measurement on arrival. Until the filter has started, all
  // but fixes are held. An inertial sample moves the state on; the others correct it.
  Outcome add(const ImuSample& sample);
  // Corrects by the body's motion from `from` to `stamp`, if the configuration uses odometry.
  Outcome add(const RelativeMotion& motion);
  // Corrects by the speed of the wheels, if `use_wheel_speed`.
  Outcome add(const WheelSpeed& sample);
  // The first usable fix starts the filter. With `use_gnss`, later fixes correct it: position and
  // velocity each at its own stamp (the outcome is the position's).
  Outcome add(const GnssFix& fix);
  // Corrects by the line and the azimuth of the road, as far as they are fed back; a reset sets
  // them.
  Outcome add(const MapFeedback& feedback);

  // Uses what an earlier drive has estimated of the car, from the next start on.
  void recall(const RememberedCalibration& remembered) { remembered_ = remembered; }
  // The first measurement starts the filter where the vehicle was left (start_at). If the first
  // fix, the first fix of the moving vehicle or the first speed contradicts this, the filter
  // forgets it at once, and starts from a fix as without it (PlaceUse::moved).
  void recall(const LastPlace& place);

  // Starts the filter from given values. Refused if they are not valid, or already_started.
  Outcome start(const KnownStart& known);

  bool initialized() const { return initialized_; }  // whether it has started
  // Returns the frame of the enu coordinates. Before the start without a given origin, it is the
  // default frame.
  const LocalFrame& frame() const { return frame_; }
  // Returns the phase and the counters by now.
  FilterStatus status() const;
  PlaceUse place() const { return status_.place; }  // as in status()
  // Returns where the vehicle is by the newest measurement, for the next run; nothing before the
  // start.
  std::optional<LastPlace> here() const;
  // Returns the lasting contradictions of each aid by the newest measurement (contradiction.h).
  const Contradictions& contradictions() const { return newest_state().contradictions; }
  // Returns the parameters of the constructor.
  const FusionParameters& parameters() const { return parameters_; }
  // Returns what the filter has estimated of the vehicle; each sigma is 0 before the start.
  SelfCalibrations calibration() const;

  // Takes over the state of a filter with the same parameters; keeps its own counts, and adds one.
  void take_over(const ReducedImuFilter& other);

  // Returns the state at `t` from all measurements known now with a stamp <= t (and from the
  // inertial sample after t, for the interpolation). After the newest measurement the state is
  // predicted. Returns nothing before the start, before the history begins, or more than `max_gap`
  // after its end.
  std::optional<FusedState> state_at(Time t) const;

  // Before the start, returns what the last fix says of the vehicle if only its course is missing,
  // for at most `max_gap` after it.
  std::optional<FusedState> state_without_course_at(Time t) const;

  // Returns the stamp of the newest measurement, or of the start; epoch 0 if there is no
  // measurement.
  Time newest() const { return guard_.newest(); }

  // Archives everything but the parameters (msgs/archive.h), including the history; about 2.4 kB
  // per event. Loading allocates. It throws ArchiveError, and changes nothing, if the archive is
  // broken, of another version, or of other parameters.
  std::size_t largest_archive() const {  // bytes
    return (static_cast<std::size_t>(parameters_.history_capacity) + 1) * sizeof(Event) + 4096;
  }
  void archive(ArchiveWriter& ar) const;
  void archive(ArchiveReader& ar);

 private:
  template <class Archive, class Filter>
  static void describe(Archive& ar, Filter& filter);
  Outcome add_before_start(const ImuSample& sample);
  // Returns whether the key lies before the start, from which no event has left the history yet.
  bool before_start(const EventKey& key) const {
    return initialized_ && history_.past.key.kind == EventKind::start && key < history_.past.key;
  }
  // Refuses a measurement with these keys for `reason` or for its stamps; otherwise makes room for
  // `events` and returns nothing.
  std::optional<Outcome> refuse(Reason reason, std::initializer_list<EventKey> keys,
                                std::size_t events);
  Outcome count(Outcome outcome);
  Reason check_stamp(const EventKey& key);
  Outcome refuse_stamp(Reason reason);
  void accept_stamp(Time stamp);
  const FilterState& newest_state() const {
    return history_.state_before(initialized_ ? history_.size() : 0);
  }

  Outcome start(const GnssFix& fix);
  bool waited_for_course(const GnssFix& fix);
  void set_origin(const Geodetic& origin);
  FilterState state_from(const GnssFix& fix) const;
  template <class MakeState>
  Outcome start_with(Reason reason, Time stamp, const Geodetic& position, MakeState make_state);
  void restart();
  void start_where_left(Time first);
  // Returns whether the fix contradicts the last place; if it does not, notes that it agrees.
  bool moved_by(const GnssFix& fix);
  Outcome moved_by(Outcome of_speed);
  void take_course(const GnssFix& fix);
  void forget_place(Time from);
  std::optional<FilterState> predicted(Time t) const;
  void make_room(std::size_t events);
  void drop_oldest();
  template <class Measurement>
  Outcome insert_and_roll(const EventKey& key, const Measurement& measurement, std::size_t redo);

  void roll_forward(std::size_t position);

  FusionParameters parameters_;
  StateVector sigmas_at_start_;
  RememberedCalibration remembered_;
  LastPlace last_place_;  // if status_.place says so
  bool has_origin_ = false;
  LocalFrame frame_;
  LocalEarth earth_;
  StampGuard guard_;
  SensorClock imu_clock_;
  EventHistory history_;
  std::optional<GnssFix> started_from_;
  std::optional<GnssFix> slow_fix_;  // the last one from before the start that shows no course
  Time uncertain_since_{};           // of the first one of these that moves; epoch 0: none
  bool initialized_ = false;
  FilterStatus status_;
};

}  // namespace maploop::fusion
