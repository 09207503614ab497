// The stereo thread: visual odometry at each image pair.
#pragma once

#include <cstddef>
#include <stop_token>
#include <vector>

#include "estimators/stereo/stereo_odometry.h"
#include "msgs/image.h"
#include "msgs/visual_motion.h"
#include "runtime/vehicle/graph/graph_stage.h"
#include "runtime/vehicle/health/reason_counts.h"
#include "runtime/vehicle/health/watchdog.h"
#include "runtime/vehicle/stages/preview_stage.h"

namespace maploop::vehicle {

// Sends each motion to fusion (in a vehicle without LiDAR odometry), map matching and the
// publisher, and with its disparities to the lidar thread.
class StereoStage final : public GraphStage {
 public:
  StereoStage(Rings& rings, stereo::StereoOdometry odometry);

  void run(runtime::DataClock& clock, Time begin, const std::stop_token& stop) override;
  std::size_t saved_bytes() const override {
    return odometry_.largest_archive() + 4 * sizeof(VisualMotion) + 4096;
  }
  std::vector<UseWatch*> uses() override { return {&use_}; }
  std::vector<RefusalCount> refusals() override { return counts_.of(spec().name); }

  void show_to(AskedImage& preview) { preview_ = &preview; }  // before run()

 private:
  void process(const StereoPair& pair, const std::stop_token& stop);
  void show(const StereoPair& pair);
  void send(VisualMotion& motion, const std::stop_token& stop);
  void save_until(Time t, const std::stop_token& stop);
  void load(ArchiveReader& ar) override { archive(ar); }
  template <class Archive>
  void archive(Archive& ar);

  stereo::StereoOdometry odometry_;
  runtime::Edge<StereoPair>& images_;
  Outputs<RelativeMotion> motions_;
  Outputs<VisualMotion> to_lidar_;
  UseWatch use_{stages::stereo.name, "image pairs", Watchdog::patience(stages::stereo)};
  AskedImage* preview_ = nullptr;   // nullptr: no preview is made
  std::vector<VisualMotion> sent_;  // motions that were not yet available at the last pair
  ReasonCounts<OdometryStatus, count_of<OdometryStatus>> counts_;
};

}  // namespace maploop::vehicle
