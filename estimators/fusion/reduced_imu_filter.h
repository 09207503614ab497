// Reduced-IMU navigation: two horizontal accelerometers, one vertical gyro and odometry in an
// extended Kalman filter that takes late data at its own stamp.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "estimators/fusion/earth.h"
#include "estimators/fusion/event_history.h"
#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/inertial_input.h"
#include "estimators/fusion/initial_state.h"
#include "estimators/fusion/outcome.h"
#include "estimators/fusion/sensor_clock.h"
#include "estimators/fusion/stamp_guard.h"
#include "msgs/gnss.h"
#include "msgs/local_frame.h"
#include "msgs/map_feedback.h"
#include "msgs/nav_state.h"
#include "msgs/wheel_speed.h"

namespace maploop {
class ArchiveReader;
class ArchiveWriter;
}  // namespace maploop

namespace maploop::fusion {

enum class Phase : std::uint8_t {
  waiting_for_fix,     // no usable GNSS fix yet
  waiting_for_motion,  // the last fix was too slow to show a course
  running,
};

struct FilterStatus {
  Phase phase = Phase::waiting_for_fix;
  std::uint64_t recoveries = 0;  // times a row of gated odometry made the filter doubt itself
  std::uint64_t reinitializations = 0;  // times it began anew at a fix that it could not believe
  DelayEstimate imu_delay;              // left in the inertial stamps, against odometry
  std::uint64_t restarts = 0;           // times a jump of the clock made it begin anew
  std::uint64_t shortened = 0;          // events that left the history early because it was full
  std::uint64_t restorations = 0;       // times what the map had led to was undone
  std::uint64_t unused = 0;  // held measurements that grew too old before the filter started
  // Of every measurement added, by its outcome when it was added (a later arrival may change what
  // the filter makes of it; NavState counts what is inside a state).
  std::uint64_t applied = 0;
  std::uint64_t held = 0;
  std::array<std::uint64_t, reason_count> refused{};  // by Reason

  std::uint64_t refused_for(Reason reason) const {
    return refused[static_cast<std::size_t>(reason)];
  }
};

template <class Archive>
void archive(Archive& ar, FilterStatus& s) {
  ar(s.phase, s.recoveries, s.reinitializations, s.imu_delay, s.restarts, s.shortened,
     s.restorations, s.unused, s.applied, s.held, s.refused);
}

// Not thread-safe; reads no clock, allocates nothing after construction.
//
// Measurements may arrive in any order and late by up to `history_length`: each is applied at its
// own stamp and everything after it is done again, so that the result has the same bits as if all
// had arrived in the order of (stamp, kind, sequence). The inertial input is interpolated between
// samples; after the newest one its value is held.
//
// Stamps of a broken clock are refused; when the clock of all data has jumped, the filter restarts
// with an empty history in the same frame and waits for a fix (StampGuard). Every measurement is
// counted in the status, as applied, held or refused with its reason.
//
// Axes are the body's (x forward, y left, z up; msgs/frames.h); its origin is taken to roll without
// side slip, as a point near the rear axle does.
class ReducedImuFilter {
 public:
  // Throws std::invalid_argument when a parameter cannot work. Without an origin, the position of
  // the fix that starts the filter becomes the origin.
  explicit ReducedImuFilter(const FusionParameters& parameters,
                            std::optional<Geodetic> origin = std::nullopt);

  Outcome add(const ImuSample& sample);
  Outcome add(const RelativeMotion& motion);
  Outcome add(const WheelSpeed& sample);
  // Starts the filter; later ones correct it where the configuration says so: position and velocity
  // each at its own stamp (the outcome is the position's).
  Outcome add(const GnssFix& fix);
  Outcome add(const MapFeedback& feedback);

  // Starts the filter from values that are known otherwise.
  Outcome start(const KnownStart& known);

  bool initialized() const { return initialized_; }
  // Of the enu coordinates; the default frame before the start when no origin was given.
  const LocalFrame& frame() const { return frame_; }
  FilterStatus status() const;

  // Becomes another one of the same parameters; what was counted stays.
  void take_over(const ReducedImuFilter& other);

  // State at `t` from every measurement known now with a stamp <= t (and the inertial sample after
  // t, for the interpolation). Beyond the newest measurement it is predicted. Nothing before the
  // history begins, or more than `max_gap` beyond its end, or before the start.
  std::optional<NavState> state_at(Time t) const;

  // Stamp of the newest measurement, or of the start; epoch 0 when there is none.
  Time newest() const { return guard_.newest(); }

  // msgs/archive.h: everything but the parameters, the history included; about 2.4 kB an event.
  // Loading throws ArchiveError, and changes nothing, where the archive is of other parameters or
  // of another version, or broken; it allocates.
  std::size_t largest_archive() const;  // bytes
  void archive(ArchiveWriter& ar) const;
  void archive(ArchiveReader& ar);

 private:
  template <class Archive, class Filter>
  static void describe(Archive& ar, Filter& filter);
  Outcome add_before_start(const ImuSample& sample);
  // Nothing has dropped out of the history since the start.
  bool started_here() const { return initialized_ && base_key_.kind == EventKind::start; }
  Outcome count(Outcome outcome);
  Reason check_stamp(const EventKey& key);
  Outcome refuse_stamp(Reason reason);
  void accept_stamp(Time stamp);

  Outcome start(const GnssFix& fix);
  template <class MakeState>
  Outcome start_with(Time stamp, const Geodetic& position, MakeState make_state);
  Outcome correct(const GnssFix& fix);
  void restart();
  void make_room(std::size_t events);
  void drop_oldest();
  template <class Measurement>
  Outcome insert_and_roll(const EventKey& key, const Measurement& measurement, std::size_t redo);

  InertialSamples samples_around(std::size_t position) const;
  std::size_t next_sample(std::size_t position) const;
  void advance(FilterState& state, const InertialSamples& samples, Time to) const;
  void apply_sample(FilterState& state, const ImuSample& sample, const ImuSample& before) const;
  Outcome apply(FilterState& state, const Event& event, const InertialSamples& samples) const;
  void roll_forward(std::size_t position);

  FusionParameters parameters_;
  bool has_origin_ = false;
  LocalFrame frame_;
  LocalEarth earth_;
  StampGuard guard_;
  SensorClock imu_clock_;
  EventHistory history_;

  // What is left of the events that dropped out of the history.
  FilterState base_;
  EventKey base_key_;
  std::optional<ImuSample> base_sample_;  // the newest inertial sample among them

  bool initialized_ = false;
  FilterStatus status_;
};

}  // namespace maploop::fusion
