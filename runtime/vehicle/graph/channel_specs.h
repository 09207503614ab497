// The LCM channels: what each shows, from which thread, and who gets it. GRAPH.md shows them.
#pragma once

#include <array>
#include <string_view>

#include "msgs/lcm/channel_names.h"

namespace maploop::vehicle {

// Which sinks get a channel (message_sink.h).
enum class Reach {
  everyone,
  log,     // too large for the network
  viewers  // made for people who look on
};

// One LCM channel.
struct ChannelSpec {
  std::string_view name;
  std::string_view type;  // in msgs/lcm
  std::string_view from;  // stage
  std::string_view shows;
  std::string_view rate;
  bool from_data = true;  // derived from data alone: hashed, and the same bits on each run
  Reach reach = Reach::everyone;
};

namespace channels {
inline constexpr ChannelSpec nav_state{.name = channel_names::nav_state,
                                       .type = "nav_state_t",
                                       .from = "fusion",
                                       .shows = "fused position, velocity, attitude, covariance",
                                       .rate = "100 Hz"};
inline constexpr ChannelSpec visual_odometry{.name = channel_names::visual_odometry,
                                             .type = "relative_motion_t",
                                             .from = "stereo",
                                             .shows = "relative pose, covariance, quality",
                                             .rate = "10 Hz"};
inline constexpr ChannelSpec lidar_odometry{
    .name = channel_names::lidar_odometry,
    .type = "lidar_motion_t",
    .from = "lidar",
    .shows = "relative pose of each scan, degenerate directions, change of its seed",
    .rate = "10 Hz"};
inline constexpr ChannelSpec odometry{.name = channel_names::odometry,
                                      .type = "relative_motion_t",
                                      .from = "lidar",
                                      .shows = "the motion that is fused, and from which sensors",
                                      .rate = "10 Hz"};
inline constexpr ChannelSpec map_match{
    .name = channel_names::map_match,
    .type = "map_match_t",
    .from = "mapmatch",
    .shows = "phase, link, matched point, P(link), candidates with their rules, reasons in words",
    .rate = "10 Hz"};
inline constexpr ChannelSpec map_feedback{.name = channel_names::map_feedback,
                                          .type = "map_feedback_t",
                                          .from = "mapmatch",
                                          .shows = "feedback to the filter, or why there was none",
                                          .rate = "10 Hz"};
inline constexpr ChannelSpec imu{.name = channel_names::imu,
                                 .type = "imu_t",
                                 .from = "imu",
                                 .shows = "inertial sample",
                                 .rate = "the sensor's"};
inline constexpr ChannelSpec gnss_fix{
    .name = channel_names::gnss_fix,
    .type = "gnss_fix_t",
    .from = "gnss",
    .shows = "position and velocity with covariance, of the receiver or of ppp",
    .rate = "1 Hz"};
inline constexpr ChannelSpec ppp_state{
    .name = channel_names::ppp_state,
    .type = "ppp_state_t",
    .from = "ppp",
    .shows =
        "position, covariance, protection levels, satellites and refusals, residuals, convergence",
    .rate = "the receiver's"};
inline constexpr ChannelSpec wheel_speed{.name = channel_names::wheel_speed,
                                         .type = "wheel_speed_t",
                                         .from = "wheel",
                                         .shows = "forward speed of the wheels",
                                         .rate = "the sensor's"};
inline constexpr ChannelSpec truth{.name = channel_names::truth,
                                   .type = "reference_pose_t",
                                   .from = "reference",
                                   .shows = "reference pose, replay only",
                                   .rate = "10 Hz"};
inline constexpr ChannelSpec camera{.name = channel_names::camera,
                                    .type = "stereo_pair_t",
                                    .from = "camera",
                                    .shows = "rectified pair, unchanged; only in logs",
                                    .rate = "10 Hz",
                                    .reach = Reach::log};
inline constexpr ChannelSpec velodyne{.name = channel_names::velodyne,
                                      .type = "lidar_scan_t",
                                      .from = "velodyne",
                                      .shows = "scan, unchanged; only in logs",
                                      .rate = "10 Hz",
                                      .reach = Reach::log};
inline constexpr ChannelSpec preview{
    .name = channel_names::preview,
    .type = "preview_t",
    .from = "preview",
    .shows = "small picture with tracks, thinned scan; not in logs",
    .rate = "2 Hz",
    .from_data = false,
    .reach = Reach::viewers};
inline constexpr ChannelSpec calibration{.name = channel_names::calibration,
                                         .type = "calibration_t",
                                         .from = "publisher",
                                         .shows = "sensors on the vehicle",
                                         .rate = "at the start",
                                         .from_data = false};
inline constexpr ChannelSpec replay_control{
    .name = channel_names::replay_control,
    .type = "replay_control_t",
    .from = "player",
    .shows = "commands to the player (in), its state (out); not in logs",
    .rate = "on change",
    .from_data = false};
inline constexpr ChannelSpec run{.name = channel_names::run,
                                 .type = "run_t",
                                 .from = "player",
                                 .shows = "id and description of each publishing run; not in logs",
                                 .rate = "1 Hz",
                                 .from_data = false};
inline constexpr ChannelSpec deadlines{.name = channel_names::deadlines,
                                       .type = "deadlines_t",
                                       .from = "health",
                                       .shows = "latency of each thread and path, misses",
                                       .rate = "1 Hz",
                                       .from_data = false};
inline constexpr ChannelSpec health{
    .name = channel_names::health,
    .type = "health_t",
    .from = "health",
    .shows = "threads, rings, rates, losses, refusals, real-time settings, degraded modes",
    .rate = "1 Hz",
    .from_data = false};

inline constexpr std::array all{
    nav_state, visual_odometry, lidar_odometry, odometry,       map_match, map_feedback,
    imu,       gnss_fix,        ppp_state,      wheel_speed,    truth,     camera,
    velodyne,  preview,         calibration,    replay_control, run,       deadlines,
    health};
}  // namespace channels
}  // namespace maploop::vehicle
