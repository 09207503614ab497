#include "runtime/vehicle/fusion_stage.h"

#include <string>
#include <utility>

#include "runtime/core/periodic.h"
#include "runtime/vehicle/graph.h"

namespace maploop::vehicle {

FusionEdges::FusionEdges(runtime::Overflow overflow)
    : imu("imu -> fusion", capacity::samples, overflow, &bell),
      gnss("gnss -> fusion", capacity::samples, overflow, &bell),
      odometry("stereo -> fusion", capacity::samples, overflow, &bell) {}

FusionStage::FusionStage(fusion::ReducedImuFilter filter, FusionEdges& inputs,
                         runtime::Edge<NavState>& nav_states,
                         runtime::Edge<NavState>& image_states)
    : filter_(std::move(filter)),
      inputs_(inputs),
      nav_states_(nav_states),
      image_states_(image_states),
      intake_(inputs.bell),
      meter_(std::string(stages::fusion.name), stages::fusion.deadline),
      camera_path_("camera stamp -> state", {}),
      imu_path_("imu stamp -> state", {}) {
  intake_.add(inputs_.imu, [this](const ImuSample& sample) { filter_.add(sample); });
  intake_.add(inputs_.gnss, [this](const GnssFix& fix) { filter_.add(fix); });
  intake_.add(inputs_.odometry, [this](const RelativeMotion& motion) { take(motion); });
}

void FusionStage::run(runtime::DataClock& clock, Time first, const std::stop_token& stop) {
  stop_ = stop;
  position_.store(to_nanoseconds(first), std::memory_order_relaxed);
  runtime::run_periodic(clock, first, stages::fusion.period, stop,
                        [&](Time k) { return tick(k, clock, stop); });
}

bool FusionStage::tick(Time k, runtime::DataClock& clock, const std::stop_token& stop) {
  const MonotonicTime due = clock.due(k);
  const MonotonicTime woken = runtime::monotonic_now();
  MonotonicTime ready = woken;
  if (intake_.promised() < k) {
    if (!intake_.wait(k, stop)) return false;
    ready = runtime::monotonic_now();
    clock.stall(k, ready);
  }
  if (intake_.finished()) return false;

  tick_ = k;
  position_.store(to_nanoseconds(k), std::memory_order_relaxed);
  intake_.take_until(k);
  NavState state = filter_.state_at(k).value_or(NavState{});
  state.stamp = k;
  state.available = k + stages::fusion.budget;
  state.sequence = ticks_++;
  const MonotonicTime computed = runtime::monotonic_now();
  nav_states_.push(state, stop);

  const MonotonicTime done = runtime::monotonic_now();
  if (done - computed > runtime::DataClock::tolerance) clock.stall(k, done);
  if (clock.is_paced()) {
    meter_.record({k, std::max(Duration::zero(), woken - due), ready - woken, done - ready});
    record_paths(clock, state, done);
  } else {
    meter_.record(done - ready);
  }
  const Time next = k + stages::fusion.period + stages::fusion.budget;
  nav_states_.promise(next - Duration(1));
  image_states_.promise(next - Duration(1));
  return true;
}

void FusionStage::take(const RelativeMotion& motion) {
  filter_.add(motion);
  std::optional<NavState> state = filter_.state_at(motion.stamp);
  if (!state) return;
  state->available = tick_ + stages::fusion.budget;
  state->sequence = images_++;
  image_states_.push(*state, stop_);
}

void FusionStage::record_paths(const runtime::DataClock& clock, const NavState& state,
                               MonotonicTime now) {
  if (state.imu_stamp != imu_seen_) imu_path_.record(now - clock.due(state.imu_stamp));
  if (state.odometry_stamp != odometry_seen_) {
    camera_path_.record(now - clock.due(state.odometry_stamp));
  }
  imu_seen_ = state.imu_stamp;
  odometry_seen_ = state.odometry_stamp;
}

void FusionStage::finish() {
  nav_states_.finish();
  image_states_.finish();
}

}  // namespace maploop::vehicle
