#include "runtime/vehicle/stages/lidar_stage.h"

#include <algorithm>
#include <utility>

#include "runtime/vehicle/graph/trace_flows.h"

namespace maploop::vehicle {
namespace {

// Memory taken beforehand for a scan that waits while it is saved; a larger one is no error.
constexpr std::size_t usual_points = 150'000;

}  // namespace

LidarStage::LidarStage(Rings& rings, lidar::VisualLidarOdometer odometer,
                       const SensorDelays& delays)
    : GraphStage(stages::lidar, rings),
      odometer_(std::move(odometer)),
      patience_(spec().patience + std::max({Duration::zero(), delays.camera, delays.lidar})),
      lidar_(outputs(rings::lidar_publisher)),
      odometry_(outputs(rings::lidar_fusion, rings::lidar_odometry_publisher)) {
  GraphStage::take(intake_, rings::velodyne_lidar, [this](LidarScan& scan) { take(scan); });
  GraphStage::take(intake_, rings::stereo_lidar,
                   [this](const VisualMotion& visual) { take(visual); });
}

void LidarStage::run(runtime::DataClock& clock, Time, const std::stop_token& stop) {
  clock_ = &clock;
  stop_ = stop;
  resend();
  while (!stop.stop_requested()) {
    const std::uint32_t heard = bell().listen();
    const Time promised = intake_.promised();
    save_until(promised);
    take_until(promised);
    if (promised == Time::max()) return;
    promise(promised + spec().budget);
    bell().wait(heard);
  }
}

// Sends the results of the run that this one resumes.
void LidarStage::resend() {
  for (const LidarMotion& motion : sent_lidar_) lidar_.push(motion, stop_);
  for (const RelativeMotion& motion : sent_odometry_) odometry_.push(motion, stop_);
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
  const auto end = [this](const Sample& sample) { return sample.available + patience_; };
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
  runtime::TraceSpan span(trace(), "lidar");
  if (visual != nullptr) span.step_flow(flow_of(*visual));
  delay(trigger);
  lidar::OdometerResult result = odometer_.process(scan, visual);
  const MonotonicTime ended = runtime::monotonic_now();

  forget_sent(trigger);
  result.lidar.available = result.odometry.available = trigger + spec().budget;
  result.lidar.received = result.odometry.received = ended;
  if (scan != nullptr) {
    counts_.add(result.lidar.status);
    note_use(use_, trigger, result.lidar.status);
    sent_lidar_.push_back(result.lidar);
    lidar_.push(result.lidar, stop_);
  }
  // A scan that is out of order is nobody's motion.
  if (visual != nullptr || result.odometry.status != OdometryStatus::bad_input) {
    sent_odometry_.push_back(result.odometry);
    odometry_.push(result.odometry, stop_);
  }
  promise(trigger + spec().budget);
  measure(result.odometry.stamp, trigger, released, started, ended, "busy with the scan before",
          *clock_);
  if (scan != nullptr) show(*scan);
}

void LidarStage::show(const LidarScan& scan) {
  if (preview_ == nullptr) return;
  preview_->offer([&](PreviewScan& slot) {
    slot.stamp = scan.stamp;
    thin(scan.points, preview_points_, slot.points);
  });
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
  cuts().save_until(t, stop_, come_to, [this](ArchiveWriter& ar, Time cut) {
    forget_sent(cut);
    archive(ar);
  });
}

// Includes the results that become available after the cut: the run that resumes sends them.
template <class Archive>
void LidarStage::archive(Archive& ar) {
  ar.section(spec().name, 3);
  ar(odometer_, counts_, sent_lidar_, sent_odometry_, scan_waits_, visual_waits_, visual_,
     turn_begin_, turn_end_);
  if (scan_waits_) ar(scan_);
}

std::size_t LidarStage::saved_bytes() const {
  return odometer_.largest_archive() + usual_points * sizeof(LidarPoint) + 4096;
}

}  // namespace maploop::vehicle
