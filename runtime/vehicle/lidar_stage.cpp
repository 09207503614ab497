#include "runtime/vehicle/lidar_stage.h"

#include <algorithm>

#include "runtime/vehicle/graph.h"
#include "runtime/vehicle/trace_flows.h"

namespace maploop::vehicle {
namespace {

// Memory taken beforehand for a scan that waits while it is saved; a larger one is no error.
constexpr std::size_t usual_points = 150'000;

}  // namespace

LidarEdges::LidarEdges()
    : scans(make_edge<LidarScan>(edges::velodyne_lidar, &bell)),
      visual(make_edge<VisualMotion>(edges::stereo_lidar, &bell)) {}

LidarStage::LidarStage(lidar::LidarOdometry odometer, lidar::DisparityCorrection correction,
                       LidarEdges& inputs, runtime::Edge<LidarMotion>& lidar,
                       std::vector<runtime::Edge<RelativeMotion>*> odometry)
    : odometer_(std::move(odometer)),
      correction_(std::move(correction)),
      inputs_(inputs),
      lidar_(lidar),
      odometry_(std::move(odometry)),
      meter_(stages::lidar) {
  intake_.add(inputs_.scans, [this](LidarScan& scan) { take(scan); });
  intake_.add(inputs_.visual, [this](const VisualMotion& visual) { take(visual); });
}

void LidarStage::run(const runtime::DataClock& clock, const std::stop_token& stop) {
  clock_ = &clock;
  stop_ = stop;
  resend();
  while (!stop.stop_requested()) {
    const std::uint32_t heard = inputs_.bell.listen();
    const Time promised = intake_.promised();
    save_until(promised);
    take_until(promised);
    if (promised == Time::max()) return;
    promise(promised + stages::lidar.budget);
    inputs_.bell.wait(heard);
  }
}

// Of the run that this one resumes.
void LidarStage::resend() {
  for (const LidarMotion& motion : sent_lidar_) send(motion);
  for (const RelativeMotion& motion : sent_odometry_) send(motion);
  scan_.received = visual_.received = runtime::monotonic_now();
}

void LidarStage::take_until(Time t) {
  intake_.take_until(t);
  let_go_until(t);
}

void LidarStage::take(LidarScan& scan) {
  let_go_until(scan.available - Duration(1));
  const Time now = scan.available;
  if (scan_waits_) scan_goes_alone(now, scan_.received);
  std::swap(scan_, scan);  // buffers circulate, nothing is copied
  scan_waits_ = true;
  turn_begin_ = scan_.start;
  turn_end_ = scan_.end;
  match(now);
}

void LidarStage::take(const VisualMotion& visual) {
  let_go_until(visual.available - Duration(1));
  const Time now = visual.available;
  if (visual.status == OdometryStatus::bad_input) {  // it belongs nowhere
    process(nullptr, &visual, now, visual.received);
    return;
  }
  if (visual_waits_) visual_goes_alone(now, visual_.received);
  visual_ = visual;
  visual_waits_ = true;
  match(now);
  if (visual_waits_ && !scan_is_due(visual_.stamp)) visual_goes_alone(now, visual_.received);
}

bool LidarStage::scan_is_due(Time t) const {
  return t <= turn_end_ + 2 * (turn_end_ - turn_begin_);
}

// Both come in order: the earlier of two that do not belong together waits in vain.
void LidarStage::match(Time now) {
  if (!scan_waits_ || !visual_waits_) return;
  if (visual_.stamp < scan_.start) {
    visual_goes_alone(now, visual_.received);
  } else if (visual_.stamp > scan_.end) {
    scan_goes_alone(now, scan_.received);
  } else {
    scan_waits_ = visual_waits_ = false;
    process(&scan_, &visual_, now, std::max(scan_.received, visual_.received));
  }
}

// What has waited long enough by then.
void LidarStage::let_go_until(Time t) {
  const auto end = [](const Sample& sample) { return sample.available + stages::lidar.patience; };
  const auto released = [&](const Sample& sample) {
    return clock_->is_paced() ? clock_->due(end(sample)) : sample.received;
  };
  if (scan_waits_ && end(scan_) <= t) scan_goes_alone(end(scan_), released(scan_));
  if (visual_waits_ && end(visual_) <= t) visual_goes_alone(end(visual_), released(visual_));
}

void LidarStage::scan_goes_alone(Time trigger, MonotonicTime released) {
  scan_waits_ = false;
  process(&scan_, nullptr, trigger, released);
}

void LidarStage::visual_goes_alone(Time trigger, MonotonicTime released) {
  visual_waits_ = false;
  process(nullptr, &visual_, trigger, released);
}

void LidarStage::process(const LidarScan* scan, const VisualMotion* visual, Time trigger,
                         MonotonicTime released) {
  const MonotonicTime started = runtime::monotonic_now();
  runtime::TraceSpan span(trace_, "lidar");
  if (visual != nullptr) span.step_flow(flow_of(*visual));
  delay_(trigger);
  lidar::OdometerResult result = lidar::process(odometer_, correction_, scan, visual);
  const MonotonicTime ended = runtime::monotonic_now();

  forget_sent(trigger);
  result.lidar.available = result.odometry.available = trigger + stages::lidar.budget;
  result.lidar.received = result.odometry.received = ended;
  if (scan != nullptr) {
    counts_[static_cast<std::size_t>(result.lidar.status)].fetch_add(1, std::memory_order_relaxed);
    note_use(use_, trigger, result.lidar.status);
    sent_lidar_.push_back(result.lidar);
    send(result.lidar);
  }
  // A scan that is out of order is nobody's motion.
  if (visual != nullptr || result.odometry.status != OdometryStatus::bad_input) {
    sent_odometry_.push_back(result.odometry);
    send(result.odometry);
  }
  promise(trigger + stages::lidar.budget);
  measure(trigger, result.odometry.stamp, released, started, ended);
  if (scan != nullptr) show(*scan);
}

void LidarStage::show(const LidarScan& scan) {
  if (preview_ == nullptr) return;
  preview_->offer([&](PreviewScan& slot) {
    slot.stamp = scan.stamp;
    thin(scan.points, preview_points_, slot.points);
  });
}

void LidarStage::measure(Time trigger, Time stamp, MonotonicTime released, MonotonicTime started,
                         MonotonicTime ended) {
  const bool missed = meter_.worked(
      {stamp, released, started, ended, cuts_.held_up(released, "busy with the scan before")},
      clock_->keeps_time(trigger));
  if (missed) runtime::trace_instant(trace_, "missed deadline");
}

void LidarStage::send(const LidarMotion& motion) {
  lidar_.push(motion, stop_);
}

void LidarStage::send(const RelativeMotion& motion) {
  for (auto* edge : odometry_) edge->push(motion, stop_);
}

void LidarStage::forget_sent(Time t) {
  std::erase_if(sent_lidar_, [t](const LidarMotion& m) { return m.available <= t; });
  std::erase_if(sent_odometry_, [t](const RelativeMotion& m) { return m.available <= t; });
}

void LidarStage::save_until(Time t) {
  const auto come_to = [this](Time cut) {
    take_until(cut);
    promise(cut);
  };
  cuts_.save_until(t, stop_, come_to, [this](ArchiveWriter& ar, Time cut) {
    forget_sent(cut);
    describe(ar, *this);
  });
}

// With the results that become available after the cut: whoever goes on from there sends them.
template <class Archive, class Stage>
void LidarStage::describe(Archive& ar, Stage& stage) {
  ar.section(stages::lidar.name, 3);
  std::array<std::uint64_t, odometry_status_count> counts{};
  std::copy(stage.counts_.begin(), stage.counts_.end(), counts.begin());
  ar(stage.odometer_, stage.correction_, counts, stage.sent_lidar_, stage.sent_odometry_,
     stage.scan_waits_, stage.visual_waits_, stage.visual_, stage.turn_begin_, stage.turn_end_);
  if (stage.scan_waits_) ar(stage.scan_);
  if constexpr (Archive::loading) {
    std::copy(counts.begin(), counts.end(), stage.counts_.begin());
  }
}

std::size_t LidarStage::saved_bytes() const {
  return odometer_.largest_archive() + usual_points * sizeof(LidarPoint) + 4096;
}

void LidarStage::resume(std::span<const std::uint8_t> saved) {
  ArchiveReader ar(saved);
  describe(ar, *this);
  ar.finish();
}

void LidarStage::promise(Time t) {
  lidar_.promise(t);
  for (auto* edge : odometry_) edge->promise(t);
}

void LidarStage::finish() {
  promise(Time::max());
  cuts_.finish();
  intake_.abandon();
}

}  // namespace maploop::vehicle
