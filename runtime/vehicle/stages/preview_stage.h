// The preview thread: small pictures and thinned scans for dashboards, now and then.
#pragma once

#include <Eigen/Geometry>
#include <stop_token>
#include <vector>

#include "msgs/image.h"
#include "msgs/lidar_scan.h"
#include "msgs/preview.h"
#include "runtime/core/asked_value.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/graph/rings.h"
#include "runtime/vehicle/health/thread_meter.h"

namespace maploop::vehicle {

// An image with the features that were followed to it; px.
struct PreviewImage {
  Time stamp{};
  GreyImage image;
  std::vector<Preview::Track> tracks;
};

// Some points of a turn.
struct PreviewScan {
  Time stamp{};
  std::vector<LidarPoint> points;  // velo
};

using AskedImage = runtime::AskedValue<PreviewImage>;
using AskedScan = runtime::AskedValue<PreviewScan>;

// Every n-th point, so that at most `most` are left.
void thin(const std::vector<LidarPoint>& points, std::size_t most, std::vector<LidarPoint>& out);

// Asks the stereo and the lidar thread for what they have just dealt with, at its own rate; they
// copy, everything else is done here. A full ring loses the newest.
class PreviewStage {
 public:
  PreviewStage(Rings& rings, const PreviewParameters& parameters,
               const Eigen::Isometry3d& T_body_velo);

  // For the threads that answer, which must end before this is gone.
  AskedImage& image() { return image_; }
  AskedScan& scan() { return scan_; }

  void run(const std::stop_token& stop);
  void finish();

  const ThreadMeter& meter() const { return meter_; }

 private:
  void look(const std::stop_token& stop);
  void add(const PreviewImage& from, Preview& preview) const;
  void add(const PreviewScan& from, Preview& preview) const;

  PreviewParameters parameters_;
  Eigen::Isometry3f T_body_velo_;
  Outputs<Preview> output_;
  AskedImage image_;
  AskedScan scan_;
  ThreadMeter meter_;
};

}  // namespace maploop::vehicle
