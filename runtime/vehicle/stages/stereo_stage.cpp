#include "runtime/vehicle/stages/stereo_stage.h"

#include <utility>

#include "runtime/vehicle/graph/take_each.h"
#include "runtime/vehicle/graph/trace_flows.h"

namespace maploop::vehicle {

StereoStage::StereoStage(Rings& rings, stereo::StereoOdometry odometry)
    : GraphStage(stages::stereo, rings),
      odometry_(std::move(odometry)),
      images_(*input(rings::camera_stereo)),
      motions_(outputs(rings::stereo_publisher, rings::stereo_fusion,
                       rings::stereo_odometry_publisher, rings::stereo_mapmatch)),
      to_lidar_(outputs(rings::stereo_lidar)) {}

void StereoStage::run(runtime::DataClock& clock, Time, const std::stop_token& stop) {
  for (VisualMotion& motion : sent_) send(motion, stop);  // of the run that this one resumes
  const auto take = [&](const StereoPair& pair) {
    const MonotonicTime started = runtime::monotonic_now();
    runtime::trace_counter(trace(), "camera -> stereo", static_cast<double>(images_.held()));
    process(pair, stop);
    measure(pair.stamp, pair.available, pair.received, started, runtime::monotonic_now(),
            "busy with the pair before", clock);
    show(pair);
  };
  take_each(
      images_, bell(), spec().budget, stop, take, [&](Time t) { save_until(t, stop); },
      [this](Time t) { promise(t); });
}

void StereoStage::process(const StereoPair& pair, const std::stop_token& stop) {
  runtime::TraceSpan span(trace(), "stereo");
  span.step_flow(flow_of(pair));
  delay(pair.available);
  VisualMotion motion = odometry_.process(pair);
  counts_.add(motion.status);
  note_use(use_, pair.available, motion.status);
  motion.available = pair.available + spec().budget;
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
  to_lidar_.push(motion, stop);
  motions_.push(motion, stop);
  promise(motion.available);
}

void StereoStage::save_until(Time t, const std::stop_token& stop) {
  const auto promise_until = [this](Time cut) { promise(cut); };
  cuts().save_until(t, stop, promise_until, [this](ArchiveWriter& ar, Time cut) {
    std::erase_if(sent_, [cut](const VisualMotion& m) { return m.available <= cut; });
    archive(ar);
  });
}

// Includes the results that become available after the cut: the run that resumes sends them.
template <class Archive>
void StereoStage::archive(Archive& ar) {
  ar.section(spec().name, 2);
  ar(odometry_, counts_, sent_);
}

}  // namespace maploop::vehicle
