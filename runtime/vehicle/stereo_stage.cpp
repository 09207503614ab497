#include "runtime/vehicle/stereo_stage.h"

#include <algorithm>
#include <utility>

#include "runtime/vehicle/graph.h"
#include "runtime/vehicle/take_each.h"
#include "runtime/vehicle/trace_flows.h"

namespace maploop::vehicle {

StereoStage::StereoStage(stereo::StereoOdometry odometry, runtime::Edge<StereoPair>& images,
                         const runtime::Doorbell& bell,
                         std::vector<runtime::Edge<RelativeMotion>*> outputs,
                         runtime::Edge<VisualMotion>* lidar)
    : odometry_(std::move(odometry)),
      images_(images),
      bell_(bell),
      outputs_(std::move(outputs)),
      lidar_(lidar),
      meter_(stages::stereo) {}

void StereoStage::run(const runtime::DataClock& clock, const std::stop_token& stop) {
  for (VisualMotion& motion : sent_) send(motion, stop);  // of the run that this one resumes
  const auto take = [&](const StereoPair& pair) {
    const MonotonicTime started = runtime::monotonic_now();
    runtime::trace_counter(trace_, "camera -> stereo", static_cast<double>(images_.held()));
    process(pair, stop);
    const MonotonicTime ended = runtime::monotonic_now();
    const bool missed = meter_.worked({pair.stamp, pair.received, started, ended,
                                       cuts_.held_up(pair.received, "busy with the pair before")},
                                      clock.keeps_time(pair.available));
    if (missed) runtime::trace_instant(trace_, "missed deadline");
    show(pair);
  };
  take_each(
      images_, bell_, stages::stereo.budget, stop, take, [&](Time t) { save_until(t, stop); },
      [this](Time t) { promise(t); });
}

void StereoStage::idle(const std::stop_token& stop) {
  save_until(Time::max(), stop);
  cuts_.finish();
}

void StereoStage::process(const StereoPair& pair, const std::stop_token& stop) {
  runtime::TraceSpan span(trace_, "stereo");
  span.step_flow(flow_of(pair));
  delay_(pair.available);
  VisualMotion motion = odometry_.process(pair);
  counts_[static_cast<std::size_t>(motion.status)].fetch_add(1, std::memory_order_relaxed);
  note_use(use_, pair.available, motion.status);
  motion.available = pair.available + stages::stereo.budget;
  std::erase_if(sent_, [&](const VisualMotion& m) { return m.available <= pair.available; });
  sent_.push_back(motion);
  send(motion, stop);
}

void StereoStage::show(const StereoPair& pair) {
  if (preview_ == nullptr) return;
  preview_->offer([&](PreviewImage& slot) {
    slot.stamp = pair.stamp;
    slot.image = pair.left;
    slot.tracks.clear();
    for (const stereo::StereoTrack& t : odometry_.tracks()) {
      slot.tracks.push_back(
          {static_cast<float>(t.previous.u_left), static_cast<float>(t.previous.v_left),
           static_cast<float>(t.current.u_left), static_cast<float>(t.current.v_left)});
    }
  });
}

void StereoStage::send(VisualMotion& motion, const std::stop_token& stop) {
  motion.received = runtime::monotonic_now();
  if (lidar_ != nullptr) lidar_->push(motion, stop);
  for (auto* output : outputs_) output->push(motion, stop);
  promise(motion.available);
}

void StereoStage::save_until(Time t, const std::stop_token& stop) {
  const auto promise_until = [this](Time cut) { promise(cut); };
  cuts_.save_until(t, stop, promise_until, [this](ArchiveWriter& ar, Time cut) {
    std::erase_if(sent_, [cut](const VisualMotion& m) { return m.available <= cut; });
    describe(ar, *this);
  });
}

// With the results that become available after the cut: whoever goes on from there sends them.
template <class Archive, class Stage>
void StereoStage::describe(Archive& ar, Stage& stage) {
  ar.section(stages::stereo.name, 2);
  std::array<std::uint64_t, odometry_status_count> counts{};
  std::copy(stage.counts_.begin(), stage.counts_.end(), counts.begin());
  ar(stage.odometry_, counts, stage.sent_);
  if constexpr (Archive::loading) {
    std::copy(counts.begin(), counts.end(), stage.counts_.begin());
  }
}

void StereoStage::resume(std::span<const std::uint8_t> saved) {
  ArchiveReader ar(saved);
  describe(ar, *this);
  ar.finish();
}

void StereoStage::promise(Time t) {
  if (lidar_ != nullptr) lidar_->promise(t);
  for (auto* output : outputs_) output->promise(t);
}

void StereoStage::finish() {
  promise(Time::max());
  cuts_.finish();
  images_.abandon();
}

}  // namespace maploop::vehicle
