#include "runtime/vehicle/stages/preview_stage.h"

#include <algorithm>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "runtime/core/periodic.h"
#include "sensors/image/jpeg.h"

namespace maploop::vehicle {
namespace {

// From asking to looking: a turn or a pair of any sensor, and its budget.
constexpr Duration answer_within = milliseconds(160);

void wait(Duration time, const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any ended;
  std::unique_lock lock(mutex);
  ended.wait_for(lock, stop, time, [] { return false; });
}

std::int16_t centimetres(float metres) {
  constexpr float most = std::numeric_limits<std::int16_t>::max();
  return static_cast<std::int16_t>(std::clamp(100.0F * metres, -most, most));
}

}  // namespace

void thin(const std::vector<LidarPoint>& points, std::size_t most, std::vector<LidarPoint>& out) {
  out.clear();
  if (most == 0) return;
  const std::size_t step = (points.size() + most - 1) / most;
  for (std::size_t i = 0; i < points.size(); i += step) out.push_back(points[i]);
}

PreviewStage::PreviewStage(Rings& rings, const PreviewParameters& parameters,
                           const Eigen::Isometry3d& T_body_velo)
    : parameters_(parameters),
      T_body_velo_(T_body_velo.cast<float>()),
      output_(rings.outputs(rings::preview_publisher)),
      meter_(stages::preview) {}

void PreviewStage::finish() {
  for (auto* ring : output_.rings()) ring->finish();
}

void PreviewStage::run(const std::stop_token& stop) {
  const Duration rest = from_seconds(1.0 / parameters_.rate) - answer_within;
  while (!stop.stop_requested()) {
    image_.ask();
    scan_.ask();
    wait(answer_within, stop);
    look(stop);
    wait(rest, stop);
  }
}

void PreviewStage::look(const std::stop_token& stop) {
  const PreviewImage* image = image_.latest();
  const PreviewScan* scan = scan_.latest();
  if (image == nullptr && scan == nullptr) return;
  const MonotonicTime started = runtime::monotonic_now();
  Preview preview;
  if (scan != nullptr) add(*scan, preview);
  if (image != nullptr) add(*image, preview);
  preview.available = preview.stamp;
  preview.received = started;
  preview.sequence = meter_.count();
  output_.push(preview, stop);
  meter_.ran(runtime::monotonic_now() - started);
}

void PreviewStage::add(const PreviewImage& from, Preview& preview) const {
  const GreyImage& full = from.image;
  if (full.empty()) return;
  const int shrink = (full.width + parameters_.width - 1) / parameters_.width;
  const cv::Mat large(full.height, full.width, CV_8U,
                      const_cast<std::uint8_t*>(full.pixels.data()));
  cv::Mat small;
  cv::resize(large, small, {full.width / shrink, std::max(1, full.height / shrink)}, 0.0, 0.0,
             cv::INTER_AREA);
  preview.stamp = from.stamp;
  preview.width = small.cols;
  preview.height = small.rows;
  sensors::encode_jpeg({small.data, small.total()}, small.cols, small.rows, parameters_.quality,
                       preview.jpeg);
  const float scale = 1.0F / static_cast<float>(shrink);
  for (const Preview::Track& t : from.tracks) {
    preview.tracks.push_back({scale * t.from_u, scale * t.from_v, scale * t.u, scale * t.v});
  }
}

void PreviewStage::add(const PreviewScan& from, Preview& preview) const {
  preview.stamp = preview.scan_stamp = from.stamp;
  preview.points.reserve(from.points.size());
  for (const LidarPoint& p : from.points) {
    const Eigen::Vector3f body = T_body_velo_ * Eigen::Vector3f(p.x, p.y, p.z);
    if (!body.allFinite()) continue;
    preview.points.push_back({centimetres(body.x()), centimetres(body.y()), centimetres(body.z())});
  }
}

}  // namespace maploop::vehicle
