// The rings of the vehicle's graph: which thread sends what to which other thread. GRAPH.md shows
// them; rings.h makes those that a vehicle has.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <tuple>

#include "estimators/fusion/last_place.h"
#include "estimators/fusion/self_calibration.h"
#include "msgs/diagnostics.h"
#include "msgs/gnss.h"
#include "msgs/image.h"
#include "msgs/imu.h"
#include "msgs/lidar_scan.h"
#include "msgs/map_doubt.h"
#include "msgs/map_feedback.h"
#include "msgs/map_match.h"
#include "msgs/nav_state.h"
#include "msgs/odom_state.h"
#include "msgs/odometry.h"
#include "msgs/ppp_state.h"
#include "msgs/preview.h"
#include "msgs/reference.h"
#include "msgs/sample.h"
#include "msgs/visual_motion.h"
#include "msgs/wheel_speed.h"
#include "ppp/satellite.h"
#include "runtime/core/edge.h"
#include "runtime/vehicle/drivers/gnss_epoch.h"
#include "runtime/vehicle/graph/stage_specs.h"

namespace maploop::vehicle {

// The health thread makes one report a second.
struct RuntimeReport : Sample {
  Health health;
  Deadlines deadlines;
  fusion::PlaceUse place{};
  std::optional<fusion::LastPlace> here;
};

// It holds what the filter had estimated of the vehicle and its sensors at the stamp.
struct CalibrationReport : Sample {
  static constexpr std::uint64_t every = 100;  // of so many states, one has it

  fusion::SelfCalibrations properties;  // each sigma is 0 before the filter has started
};

// A ring exists in a vehicle that has both of its ends, and if this holds as well.
enum class RingNeeds {
  both_ends,
  raw_log,       // a log of raw images and scans is written
  feedback,      // the map feeds back to the fusion
  ppp_feedback,  // the map feeds back to PPP as well
  carried        // the vehicle's motion carries PPP
};

// One ring of samples of type T: single producer, single consumer. A replay loses nothing: a full
// ring blocks its producer, and with it the data clock.
template <class T>
struct RingSpec {
  const StageSpec& from;
  const StageSpec& to;
  std::size_t capacity;          // samples: few of large ones, seconds of data of small ones
  std::string_view branch = {};  // tells apart two rings between the same stages
  const StageSpec* instead_of =
      nullptr;  // a vehicle with this stage has its ring, and not this one
  RingNeeds needs = RingNeeds::both_ends;
  runtime::Overflow overflow = runtime::Overflow::keep_all;

  // "mapmatch feedback -> publisher"
  std::string name() const {
    std::string text(from.name);
    if (!branch.empty()) text.append(" ").append(branch);
    return text.append(" -> ").append(to.name);
  }
};

namespace rings {
using stages::fusion, stages::publisher, stages::mapmatch;

inline constexpr RingSpec<StereoPair> camera_stereo{stages::camera, stages::stereo, 4};
inline constexpr RingSpec<LidarScan> velodyne_lidar{stages::velodyne, stages::lidar, 4};
inline constexpr RingSpec<VisualMotion> stereo_lidar{stages::stereo, stages::lidar, 256};
inline constexpr RingSpec<ImuSample> imu_fusion{stages::imu, fusion, 256};
inline constexpr RingSpec<WheelSpeed> wheel_fusion{stages::wheel, fusion, 256};
// The receiver gives either fixes, or observations from which ppp makes the fixes.
inline constexpr RingSpec<GnssFix> gnss_fusion{
    .from = stages::gnss, .to = fusion, .capacity = 256, .instead_of = &stages::ppp};
inline constexpr RingSpec<GnssEpoch> gnss_ppp{stages::gnss, stages::ppp, 64};
inline constexpr RingSpec<GnssCorrections> corrections_ppp{stages::corrections, stages::ppp, 256};
inline constexpr RingSpec<GnssFix> ppp_fusion{stages::ppp, fusion, 256};
// The odometry that is fused: visual-LiDAR odometry, or visual odometry without it, or a log's.
inline constexpr RingSpec<RelativeMotion> lidar_fusion{stages::lidar, fusion, 256};
inline constexpr RingSpec<RelativeMotion> stereo_fusion{
    .from = stages::stereo, .to = fusion, .capacity = 256, .instead_of = &stages::lidar};
inline constexpr RingSpec<RelativeMotion> odometry_fusion{stages::odometry, fusion, 256};
inline constexpr RingSpec<NavState> fusion_mapmatch{fusion, mapmatch, 256};
inline constexpr RingSpec<RelativeMotion> stereo_mapmatch{stages::stereo, mapmatch, 256};
inline constexpr RingSpec<RelativeMotion> visual_log_mapmatch{stages::visual_log, mapmatch, 256};
inline constexpr RingSpec<MapFeedback> mapmatch_fusion{
    .from = mapmatch, .to = fusion, .capacity = 16, .needs = RingNeeds::feedback};
inline constexpr RingSpec<MapFeedback> mapmatch_ppp{
    .from = mapmatch, .to = stages::ppp, .capacity = 16, .needs = RingNeeds::ppp_feedback};
inline constexpr RingSpec<FusedState> fusion_ppp{
    .from = fusion, .to = stages::ppp, .capacity = 256, .needs = RingNeeds::carried};
inline constexpr RingSpec<StereoPair> camera_publisher{
    .from = stages::camera, .to = publisher, .capacity = 4, .needs = RingNeeds::raw_log};
inline constexpr RingSpec<LidarScan> velodyne_publisher{
    .from = stages::velodyne, .to = publisher, .capacity = 4, .needs = RingNeeds::raw_log};
inline constexpr RingSpec<ImuSample> imu_publisher{stages::imu, publisher, 256};
inline constexpr RingSpec<GnssFix> gnss_publisher{
    .from = stages::gnss, .to = publisher, .capacity = 256, .instead_of = &stages::ppp};
inline constexpr RingSpec<GnssFix> ppp_fix_publisher{stages::ppp, publisher, 256, "fix"};
inline constexpr RingSpec<WheelSpeed> wheel_publisher{stages::wheel, publisher, 256};
inline constexpr RingSpec<ReferencePose> reference_publisher{stages::reference, publisher, 256};
inline constexpr RingSpec<RelativeMotion> stereo_publisher{stages::stereo, publisher, 256};
inline constexpr RingSpec<RelativeMotion> visual_log_publisher{stages::visual_log, publisher, 256};
inline constexpr RingSpec<LidarMotion> lidar_publisher{stages::lidar, publisher, 256};
inline constexpr RingSpec<LidarMotion> lidar_log_publisher{stages::lidar_log, publisher, 256};
inline constexpr RingSpec<RelativeMotion> lidar_odometry_publisher{stages::lidar, publisher, 256,
                                                                   "odometry"};
inline constexpr RingSpec<RelativeMotion> stereo_odometry_publisher{.from = stages::stereo,
                                                                    .to = publisher,
                                                                    .capacity = 256,
                                                                    .branch = "odometry",
                                                                    .instead_of = &stages::lidar};
inline constexpr RingSpec<RelativeMotion> odometry_publisher{stages::odometry, publisher, 256};
inline constexpr RingSpec<PppState> ppp_publisher{stages::ppp, publisher, 64};
inline constexpr RingSpec<FusedState> fusion_publisher{fusion, publisher, 1024};
inline constexpr RingSpec<FusedState> image_states{fusion, publisher, 256, "at images"};
inline constexpr RingSpec<CalibrationReport> calibration_publisher{fusion, publisher, 16,
                                                                   "calibration"};
inline constexpr RingSpec<MapMatch> mapmatch_publisher{mapmatch, publisher, 64};
inline constexpr RingSpec<MapDoubt> doubt_publisher{mapmatch, publisher, 16, "doubts"};
inline constexpr RingSpec<MapFeedback> feedback_publisher{.from = mapmatch,
                                                          .to = publisher,
                                                          .capacity = 64,
                                                          .branch = "feedback",
                                                          .needs = RingNeeds::feedback};
inline constexpr RingSpec<Preview> preview_publisher{.from = stages::preview,
                                                     .to = publisher,
                                                     .capacity = 2,
                                                     .overflow = runtime::Overflow::drop_newest};
inline constexpr RingSpec<RuntimeReport> health_publisher{stages::health, publisher, 8};

// Each stage that is saved has one ring of this capacity to the snapshot thread. Cuts are seconds
// apart, and a saved state has megabytes.
inline constexpr std::size_t snapshot_capacity = 1;

// Returns what each slot of a ring holds before it is used. It has room for buffers that would
// otherwise grow in a real-time thread.
template <class T>
T prototype() {
  T sample{};
  if constexpr (std::same_as<T, PppState>) sample.satellites.resize(ppp::usual_satellites);
  return sample;
}

// Images and scans that a replay decodes ahead: longer than a hiccup of the disk.
inline constexpr std::size_t decoded_ahead = 6;

// In this order consumers take samples that become available at the same time.
inline constexpr auto all = std::tie(
    camera_stereo, velodyne_lidar, stereo_lidar, imu_fusion, gnss_fusion, gnss_ppp, corrections_ppp,
    ppp_fusion, wheel_fusion, lidar_fusion, stereo_fusion, odometry_fusion, fusion_mapmatch,
    stereo_mapmatch, visual_log_mapmatch, mapmatch_fusion, mapmatch_ppp, fusion_ppp,
    camera_publisher, velodyne_publisher, imu_publisher, gnss_publisher, ppp_fix_publisher,
    wheel_publisher, reference_publisher, stereo_publisher, visual_log_publisher, lidar_publisher,
    lidar_log_publisher, lidar_odometry_publisher, stereo_odometry_publisher, odometry_publisher,
    ppp_publisher, fusion_publisher, image_states, calibration_publisher, mapmatch_publisher,
    doubt_publisher, feedback_publisher, preview_publisher, health_publisher);
}  // namespace rings

// What a thread gives to another on request: the newest value, without blocking.
struct CellSpec {
  std::string_view name;
  std::string_view carries;
};

namespace cells {
inline constexpr std::array all{CellSpec{"stereo -> preview", "PreviewImage"},
                                CellSpec{"lidar -> preview", "PreviewScan"}};
}  // namespace cells
}  // namespace maploop::vehicle
