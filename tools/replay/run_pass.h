// What one run of the vehicle gives, gathered while it runs, and how good it is.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "msgs/map_feedback.h"
#include "runtime/vehicle/drivers/recording.h"
#include "runtime/vehicle/output/channel_hashes.h"
#include "runtime/vehicle/output/log_recorder.h"
#include "runtime/vehicle/output/publisher.h"
#include "runtime/vehicle/stages/road_map.h"
#include "sensors/replay/reference_trajectory.h"
#include "tools/evaluate/motion_chain.h"
#include "tools/evaluate/trajectory_file.h"
#include "tools/match/match_score.h"
#include "tools/replay/fusion_score.h"
#include "tools/replay/replay_result.h"

namespace maploop::tools {

// add() is called on one thread, the rest after the run.
class TrajectoryCollector {
 public:
  // Odometry is chained, in its first frame of the body. A refused motion is replaced by the last
  // velocities.
  void add(const RelativeMotion& motion) { poses_[motion.stamp] = chain_.add(motion); }
  // The pose of a fused state, in `enu` or in the frame of odometry, is one of the axes in which
  // the sensors are described, so that it can be compared with odometry.
  void add(const FusedState& state, const Eigen::Vector3d& position, const Attitude& attitude);

  // Returns T_frame_body at each stamp, times `T_body_point`.
  evaluation::StampedTrajectory poses(
      const Eigen::Isometry3d& T_body_point = Eigen::Isometry3d::Identity()) const;

  // Scores the poses of the left camera where it has a true one. Returns nothing if these are fewer
  // than two.
  using Reference = std::function<std::optional<Eigen::Isometry3d>(Time)>;
  std::optional<Accuracy> score(const Reference& camera, const Eigen::Isometry3d& T_body_cam) const;

 private:
  evaluation::MotionChain chain_;
  std::map<Time, Eigen::Isometry3d> poses_;  // of the body
};

// The matcher's result at one time.
struct RoadMoment : match::TimedMatch {
  MatchPhase phase = MatchPhase::initial;
  bool on_road = false;
  Geodetic place;  // the matched position, on a road only
};

RoadMoment road_moment(const MapMatch& match);

// Filled on the publisher's thread; to be read after the run.
struct RunPass {
  explicit RunPass(Time cut = Time::min()) : hashes_after(cut) {}

  // Neither may outlive the pass. The second keeps the last state alone, whatever the length of the
  // run.
  vehicle::Observer observer();
  vehicle::Observer end_observer();

  vehicle::ChannelHashes hashes;
  vehicle::ChannelHashes hashes_after;               // of messages after the cut
  std::unique_ptr<vehicle::LogRecorder> recorder;    // nullptr: no log was asked for
  std::unique_ptr<vehicle::LogRecorder> black_box;   // the same
  TrajectoryCollector odometry, lidar, fused, odom;  // at images
  TrajectoryCollector odom_track;                    // at the states of `track`
  fusion_score::NavTrack track;
  std::vector<NavProtection> protection;  // of the states of `track`
  std::optional<NavState> end;            // the last fused state
  std::map<Time, PppState> ppp_states;
  std::map<Time, RoadMoment> matches;
  std::vector<vehicle::CalibrationReport> calibrations;  // once a second
  std::array<std::uint64_t, count_of<FeedbackReason>> feedbacks{};
};

// Scores the outages of a recording that has fixes to score with; nothing for another one.
std::vector<fusion_score::OutageEnd> outage_ends(const fusion_score::NavTrack& track,
                                                 const vehicle::Recording& recording,
                                                 const std::vector<ReferencePose>& reference);

// Fills what the result of any run contains.
ReplayResult result_of(const RunPass& pass, const vehicle::VehicleReport& report);

constexpr double far_from_map = 5'000.0;  // m

// Returns the roads about the drive. The map must outlive them. Throws std::runtime_error if a tile
// of the map is damaged.
std::shared_ptr<const mapmatch::RoadNetwork> roads_about(const RunPass& pass,
                                                         const vehicle::RoadMap& map);

// Adds what the recording contains, the accuracy against `reference`, the links against those
// driven, and whether the run was on its map, to the result. `map` is nullptr without a map. Ways
// of the left camera are scored against `camera_truth`; without one (nullptr) against the reference
// of the body and the described place of the camera. What comes less than `after` the drive's begin
// is not scored.
void score(ReplayResult& result, const RunPass& pass, const vehicle::Recording& recording,
           const std::vector<ReferencePose>& reference, const vehicle::RoadMap* map,
           const sensors::ReferenceTrajectory* camera_truth = nullptr, Duration after = {});

}  // namespace maploop::tools
