#include "runtime/vehicle/fusion_stage.h"

#include <utility>

#include "runtime/core/periodic.h"
#include "runtime/vehicle/graph.h"
#include "runtime/vehicle/trace_flows.h"
#include "runtime/vehicle/watchdog.h"

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
         reason != already_started && reason != too_slow;
}

void note(UseWatch& use, const Sample& sample, const fusion::Outcome& outcome) {
  if (!outcome.refused()) {
    use.note(sample.available, nullptr);
  } else if (wanted(outcome.reason)) {
    use.note(sample.available, to_string(outcome.reason).data());
  }
}

}  // namespace

FusionEdges::FusionEdges(bool closed)
    : imu(make_edge<ImuSample>(edges::imu_fusion, &bell)),
      gnss(make_edge<GnssFix>(edges::gnss_fusion, &bell)),
      wheel(make_edge<WheelSpeed>(edges::wheel_fusion, &bell)),
      odometry(make_edge<RelativeMotion>(edges::odometry_fusion, &bell)) {
  if (!closed) return;
  const EdgeSpec& spec = edges::mapmatch_fusion;
  feedback.emplace(std::string(spec.name), spec.capacity, spec.overflow, &bell);
}

FusionStage::FusionStage(fusion::GuardedFilter filter, FusionEdges& inputs,
                         std::vector<runtime::Edge<NavState>*> nav_states,
                         runtime::Edge<NavState>& image_states, Duration odometry_budget)
    : filter_(std::move(filter)),
      inputs_(inputs),
      nav_states_(std::move(nav_states)),
      image_states_(image_states),
      odometry_budget_(odometry_budget),
      imu_use_(stages::fusion.name, "inertial samples", Watchdog::patience(stages::imu)),
      gnss_use_(stages::fusion.name, "GNSS fixes", Watchdog::patience(stages::gnss)),
      wheel_use_(stages::fusion.name, "wheel speeds", Watchdog::patience(stages::imu)),
      odometry_use_(stages::fusion.name, "motions", Watchdog::patience(stages::odometry)),
      meter_(stages::fusion),
      camera_path_(paths::camera.name, paths::camera.deadline),
      imu_path_(paths::imu.name, paths::imu.deadline) {
  sent_states_.reserve(1);
  sent_image_states_.reserve(most_images_a_tick);
  intake_.add(inputs_.imu, [this](const ImuSample& sample) {
    runtime::TraceSpan span(trace_, "imu");
    span.step_flow(flow_of(sample));
    note(imu_use_, sample, filter_.add(sample));
    imu_taken_ = sample;
  });
  intake_.add(inputs_.gnss, [this](const GnssFix& fix) {
    runtime::TraceSpan span(trace_, "gnss");
    span.step_flow(flow_of(fix));
    note(gnss_use_, fix, filter_.add(fix));
  });
  intake_.add(inputs_.wheel, [this](const WheelSpeed& sample) {
    const runtime::TraceSpan span(trace_, "wheel");
    note(wheel_use_, sample, filter_.add(sample));
  });
  intake_.add(inputs_.odometry, [this](const RelativeMotion& motion) { take(motion); });
  if (!inputs_.feedback) return;
  intake_.add_feedback(*inputs_.feedback, [this](const MapFeedback& feedback) {
    const runtime::TraceSpan span(trace_, "map feedback");
    filter_.add(feedback);
  });
}

void FusionStage::run(runtime::DataClock& clock, Time first, const std::stop_token& stop) {
  stop_ = stop;
  // Of the run that this one resumes.
  for (const NavState& state : sent_states_) send(state);
  for (const NavState& state : sent_image_states_) image_states_.push(state, stop);
  position_.store(to_nanoseconds(first), std::memory_order_relaxed);
  // What the graph declares is of a live run: the same bits need every tick.
  const runtime::Schedule schedule{
      stages::fusion.period, stages::fusion.phase,
      clock.is_live() ? stages::fusion.overrun : runtime::Overrun::catch_up};
  // No state before the first tick's: the map matching need not wait for one.
  const Time before = runtime::first_tick(first, schedule.period, schedule.phase) +
                      stages::fusion.budget - Duration(1);
  for (auto* edge : nav_states_) edge->promise(before);
  runtime::run_periodic(clock, first, schedule, stop,
                        [&](const runtime::Tick& t) { return tick(t, clock, stop); });
}

bool FusionStage::tick(const runtime::Tick& tick, runtime::DataClock& clock,
                       const std::stop_token& stop) {
  const Time k = tick.time;
  const runtime::TraceSpan span(trace_, "tick");
  const auto stall = [&](MonotonicTime when) {
    if (clock.stall(k, when)) runtime::trace_instant(trace_, "stall");
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
    const runtime::TraceSpan waiting(trace_, "waiting for input");
    if (!intake_.wait(k, inputs_.bell, stop)) return false;
    ready = runtime::monotonic_now();
    stall(ready);
  }
  if (intake_.finished() && intake_.taken() == taken_before) return false;

  position_.store(to_nanoseconds(k), std::memory_order_relaxed);
  delay_(k);
  intake_.take_until(k);
  NavState state = filter_.aided().state_at(k).value_or(NavState{});
  state.stamp = k;
  state.available = k + stages::fusion.budget;
  state.sequence = ticks_++;
  const MonotonicTime computed = runtime::monotonic_now();
  send(state);
  sent_states_.push_back(state);
  filter_status_.back() = filter_.status();
  filter_status_.publish();
  runtime::trace_counter(trace_, "fusion -> publisher",
                         static_cast<double>(nav_states_.front()->held()));

  const MonotonicTime done = runtime::monotonic_now();
  if (done - computed > runtime::DataClock::tolerance) stall(done);
  meter_.ran(done - ready);
  if (clock.keeps_time(k)) {
    meter_.woke(tick, clock, due, woken);
    const bool missed = meter_.latency().record({k,
                                                 done - due,
                                                 {{{"woken late", woken - due},
                                                   {intake_.waiting(), ready - woken},
                                                   {"running", done - ready}}}});
    if (missed) runtime::trace_instant(trace_, "missed deadline");
    record_paths(clock, due, done);
  } else {
    meter_.latency().record(done - ready);
  }
  if (done - due > furthest_behind) stall(done);
  const Time next = k + stages::fusion.period + stages::fusion.budget;
  for (auto* edge : nav_states_) edge->promise(next - Duration(1));
  image_states_.promise(next - Duration(1));
  save_until(k + stages::fusion.period - Duration(1), stop);
  return true;
}

void FusionStage::send(const NavState& state) {
  for (auto* edge : nav_states_) edge->push(state, stop_);
}

void FusionStage::take(const RelativeMotion& motion) {
  runtime::TraceSpan span(trace_, "odometry");
  span.step_flow(flow_of(motion));
  note(odometry_use_, motion, filter_.add(motion));
  if (motion.status == OdometryStatus::ok) odometry_taken_ = motion;
  std::optional<NavState> state = filter_.aided().state_at(motion.stamp);
  if (!state) return;
  state->available = tick_ + stages::fusion.budget;
  state->sequence = images_++;
  image_states_.push(*state, stop_);
  sent_image_states_.push_back(*state);
}

// After the tick, in the time that is left until the next one.
void FusionStage::save_until(Time t, const std::stop_token& stop) {
  cuts_.save_until(t, stop, [this](ArchiveWriter& ar, Time) { describe(ar, *this); });
}

// What the tick at the cut has sent becomes available after it: whoever goes on sends it.
template <class Archive, class Stage>
void FusionStage::describe(Archive& ar, Stage& stage) {
  ar.section(stages::fusion.name, 1);
  ar(stage.filter_, stage.ticks_, stage.images_, stage.sent_states_, stage.sent_image_states_);
}

void FusionStage::resume(std::span<const std::uint8_t> saved) {
  ArchiveReader ar(saved);
  describe(ar, *this);
  ar.finish();
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
    if (missed) runtime::trace_instant(trace_, "missed deadline: camera path");
  }
  if (imu_taken_) {
    const Sample& s = *imu_taken_;
    const bool missed =
        imu_path_.record({s.stamp,
                          done - clock.due(s.stamp),
                          {{{"imu", s.received - clock.due(s.stamp) - paths::imu_delay},
                            {"fusion", fusion_late},
                            {}}}});
    if (missed) runtime::trace_instant(trace_, "missed deadline: imu path");
  }
}

void FusionStage::finish() {
  for (auto* edge : nav_states_) edge->finish();
  image_states_.finish();
  cuts_.finish();
  intake_.abandon();
}

}  // namespace maploop::vehicle
