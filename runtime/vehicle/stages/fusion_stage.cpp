#include "runtime/vehicle/stages/fusion_stage.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "runtime/vehicle/graph/trace_flows.h"
#include "runtime/vehicle/health/watchdog.h"

namespace maploop::vehicle {
namespace {

// The kernel's hiccups are caught up with; a stage that is too slow for the data is not one of
// them.
constexpr Duration furthest_behind = 5 * stages::fusion.period;

// Memory taken beforehand; more, such as after a delay of the camera, is no error.
constexpr std::size_t most_images_a_tick = 8;

// What does not speak against the sensor: the configuration has no use for the measurement, now or
// at all, or it has it already.
bool wanted(fusion::Reason reason) {
  using enum fusion::Reason;
  return reason != duplicate && reason != before_start && reason != not_configured &&
         reason != already_started && reason != no_course;
}

// Both outputs have the same times.
void stamp(FusedState& state, Time at, Time available, std::uint64_t sequence) {
  state.stamp = state.odom.stamp = at;
  state.available = state.odom.available = available;
  state.sequence = state.odom.sequence = sequence;
}

void note(UseWatch& use, const Sample& sample, const fusion::Outcome& outcome) {
  if (!outcome.refused()) {
    use.note(sample.available, nullptr);
  } else if (wanted(outcome.reason)) {
    use.note(sample.available, to_string(outcome.reason).data());
  }
}

}  // namespace

FusionStage::FusionStage(Rings& rings, fusion::GuardedFilter filter,
                         fusion::ProtectionMonitor protection, Duration odometry_budget)
    : GraphStage(stages::fusion, rings),
      filter_(std::move(filter)),
      protection_(std::move(protection)),
      states_(outputs(rings::fusion_publisher, rings::fusion_ppp)),
      states_to_match_(outputs(rings::fusion_mapmatch)),
      image_states_(outputs(rings::image_states)),
      calibrations_(outputs(rings::calibration_publisher)),
      odometry_budget_(odometry_budget),
      imu_use_(stages::fusion.name, "inertial samples", Watchdog::patience(stages::imu)),
      gnss_use_(stages::fusion.name, "GNSS fixes", Watchdog::patience(stages::gnss)),
      wheel_use_(stages::fusion.name, "wheel speeds", Watchdog::patience(stages::imu)),
      odometry_use_(stages::fusion.name, "motions", Watchdog::patience(stages::odometry)),
      doubts_(filter_.aided()),
      camera_path_(paths::camera.name, paths::camera.deadline),
      imu_path_(paths::imu.name, paths::imu.deadline) {
  sent_states_.reserve(1);
  sent_image_states_.reserve(most_images_a_tick);
  GraphStage::take(intake_, rings::imu_fusion, [this](const ImuSample& sample) {
    runtime::TraceSpan span(trace(), "imu");
    span.step_flow(flow_of(sample));
    note(imu_use_, sample, filter_.add(sample));
    imu_taken_ = sample;
  });
  for (const auto* fixes : {&rings::gnss_fusion, &rings::ppp_fusion}) {
    GraphStage::take(intake_, *fixes, [this](const GnssFix& fix) { take(fix); });
  }
  GraphStage::take(intake_, rings::wheel_fusion, [this](const WheelSpeed& sample) {
    const runtime::TraceSpan span(trace(), "wheel");
    note(wheel_use_, sample, filter_.add(sample));
    doubts_.judge_wheel(sample.available);
  });
  for (const auto* motions :
       {&rings::lidar_fusion, &rings::stereo_fusion, &rings::odometry_fusion}) {
    GraphStage::take(intake_, *motions, [this](const RelativeMotion& motion) { take(motion); });
  }
  if (runtime::Edge<MapFeedback>* ring = input(rings::mapmatch_fusion)) {
    feedback_ = true;
    intake_.add_feedback(*ring, [this](const MapFeedback& feedback) {
      const runtime::TraceSpan span(trace(), "map feedback");
      filter_.add(feedback);
    });
  }
}

void FusionStage::run(runtime::DataClock& clock, Time begin, const std::stop_token& stop) {
  stop_ = stop;
  // Results of the run that this one resumes.
  for (const FusedState& state : sent_states_) send(state, stop);
  for (const FusedState& state : sent_image_states_) image_states_.push(state, stop);
  position_.store(to_nanoseconds(begin), std::memory_order_relaxed);
  const runtime::Schedule schedule = this->schedule(clock);
  // Before the first tick there is no state for which the map matching would have to wait.
  promise(runtime::first_tick(begin, schedule.period, schedule.phase) + spec().budget -
          Duration(1));
  runtime::run_periodic(clock, begin, schedule, stop,
                        [&](const runtime::Tick& t) { return tick(t, clock, stop); });
}

bool FusionStage::tick(const runtime::Tick& tick, runtime::DataClock& clock,
                       const std::stop_token& stop) {
  const Time k = tick.time;
  const runtime::TraceSpan span(trace(), "tick");
  const auto stall = [&](MonotonicTime when) {
    if (clock.stall(k, when)) runtime::trace_instant(trace(), "stall");
  };
  const MonotonicTime due = clock.due(k);
  const MonotonicTime woken = runtime::monotonic_now();
  MonotonicTime ready = woken;
  const std::uint64_t taken_before = intake_.taken();
  tick_ = k;
  imu_taken_.reset();
  odometry_taken_.reset();
  sent_states_.clear();
  sent_image_states_.clear();
  if (!clock.is_live() && intake_.promised() < k) {
    const runtime::TraceSpan waiting(trace(), "waiting for input");
    if (!intake_.wait(k, bell(), stop)) return false;
    ready = runtime::monotonic_now();
    stall(ready);
  }
  if (intake_.finished() && intake_.taken() == taken_before) return false;

  position_.store(to_nanoseconds(k), std::memory_order_relaxed);
  delay(k);
  intake_.take_until(k);
  const fusion::ReducedImuFilter& filter = filter_.aided();
  std::optional<FusedState> known = filter.state_at(k);
  if (!known) known = filter.state_without_course_at(k);
  FusedState state = known.value_or(FusedState{});
  stamp(state, k, k + spec().budget, ticks_++);
  if (known && state.sequence % NavProtection::every == 0) {
    state.protection = protection_.levels(state, filter_);
    state.protection->doubted = doubts_.any(k);
  }
  const MonotonicTime computed = runtime::monotonic_now();
  send(state, stop);
  sent_states_.push_back(state);
  filter_reports_.back() = {filter_.status(), filter_.calibration(), filter.here()};
  filter_reports_.publish();
  runtime::trace_counter(trace(), "fusion -> publisher",
                         static_cast<double>(states_.rings().front()->held()));

  const MonotonicTime done = runtime::monotonic_now();
  if (done - computed > runtime::DataClock::tolerance) stall(done);
  measure(tick, {due, woken, ready, done}, intake_.waiting(), clock);
  if (clock.keeps_time(k)) record_paths(clock, due, done);
  if (done - due > furthest_behind) stall(done);
  promise(k + spec().period + spec().budget - Duration(1));
  save_until(k + spec().period - Duration(1), stop);
  return true;
}

void FusionStage::take(const GnssFix& fix) {
  runtime::TraceSpan span(trace(), "gnss");
  span.step_flow(flow_of(fix));
  const fusion::Outcome outcome = filter_.add(fix);
  note(gnss_use_, fix, outcome);
  if (!outcome.refused() || outcome.reason == fusion::Reason::position_gate)
    protection_.note(fix, filter_.aided());
  doubts_.judge_fix(fix.available);
}

void FusionStage::take(const RelativeMotion& motion) {
  runtime::TraceSpan span(trace(), "odometry");
  span.step_flow(flow_of(motion));
  note(odometry_use_, motion, filter_.add(motion));
  doubts_.judge_motion(motion.available);
  if (motion.status == OdometryStatus::ok) odometry_taken_ = motion;
  std::optional<FusedState> state = filter_.aided().state_at(motion.stamp);
  if (!state) return;
  stamp(*state, motion.stamp, tick_ + spec().budget, images_++);
  image_states_.push(*state, stop_);
  sent_image_states_.push_back(*state);
}

void FusionStage::send(const FusedState& state, const std::stop_token& stop) {
  states_.push(state, stop);
  states_to_match_.push(state, stop);
  if (state.sequence % CalibrationReport::every == 0)
    calibrations_.push({Sample(state), filter_.calibration()}, stop);
}

// After the tick, in the time that is left until the next one.
void FusionStage::save_until(Time t, const std::stop_token& stop) {
  cuts().save_until(t, stop, [this](ArchiveWriter& ar, Time) { archive(ar); });
}

// Includes what the tick at the cut sent: it becomes available after the cut, and the run that
// resumes sends it.
template <class Archive>
void FusionStage::archive(Archive& ar) {
  ar.section(spec().name, 5);
  ar(filter_, protection_, doubts_, ticks_, images_, sent_states_, sent_image_states_);
}

std::vector<UseWatch*> FusionStage::uses() {
  std::vector<UseWatch*> all{&imu_use_, &gnss_use_, &wheel_use_, &odometry_use_};
  for (UseWatch* watch : doubts_.watches()) all.push_back(watch);
  return all;
}

std::vector<RefusalCount> FusionStage::refusals() {
  std::vector<RefusalCount> all;
  const auto add = [&](std::string_view reason, std::uint64_t count) {
    if (count > 0) all.push_back({std::string(spec().name), std::string(reason), count});
  };
  const fusion::FilterStatus& filter = filter_report().status;
  for (std::size_t i = 1; i < fusion::reason_count; ++i) {
    const auto reason = static_cast<fusion::Reason>(i);
    add(to_string(reason), filter.refused_for(reason));
  }
  add("held, and too old before the start", filter.unused);
  add("recovery: the prediction was doubted", filter.recoveries);
  add("begun anew at a fix", filter.reinitializations);
  add("restart: the clock jumped", filter.restarts);
  add("undone: the map had led astray", filter.restorations);
  add(to_string(filter.place), fusion::dropped(filter.place) ? 1 : 0);
  return all;
}

void FusionStage::record_paths(const runtime::DataClock& clock, MonotonicTime due,
                               MonotonicTime done) {
  // What each stage took beyond what the graph's table allows it.
  const Duration fusion_late = done - due - stages::fusion.deadline;
  if (odometry_taken_) {
    const Sample& s = *odometry_taken_;
    const Time image_available = s.available - odometry_budget_;
    const bool missed =
        camera_path_.record({s.stamp,
                             done - clock.due(s.stamp),
                             {{{"camera", image_available - s.stamp - paths::camera_delay},
                               {"odometry", s.received - clock.due(s.available)},
                               {"fusion", fusion_late}}}});
    if (missed) runtime::trace_instant(trace(), "missed deadline: camera path");
  }
  if (imu_taken_) {
    const Sample& s = *imu_taken_;
    const bool missed =
        imu_path_.record({s.stamp,
                          done - clock.due(s.stamp),
                          {{{"imu", s.received - clock.due(s.stamp) - paths::imu_delay},
                            {"fusion", fusion_late},
                            {}}}});
    if (missed) runtime::trace_instant(trace(), "missed deadline: imu path");
  }
}

}  // namespace maploop::vehicle
