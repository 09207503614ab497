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
  bool from_data;  // derived from data alone: hashed, and the same bits on each run
  Reach reach;
};

namespace channels {
using Text = std::string_view;
constexpr ChannelSpec of_data(Text name, Text type, Text from, Text shows, Text rate,
                              Reach reach = Reach::everyone) {
  return {name, type, from, shows, rate, true, reach};
}
constexpr ChannelSpec of_run(Text name, Text type, Text from, Text shows, Text rate,
                             Reach reach = Reach::everyone) {
  return {name, type, from, shows, rate, false, reach};
}

inline constexpr ChannelSpec nav_state =
    of_data(channel_names::nav_state, "nav_state_t", "fusion",
            "fused position, velocity, attitude, covariance", "100 Hz");
inline constexpr ChannelSpec odom_state =
    of_data(channel_names::odom_state, "odom_state_t", "fusion",
            "continuous pose in the frame of odometry, without absolute corrections", "100 Hz");
inline constexpr ChannelSpec nav_protection = of_data(
    channel_names::nav_protection, "nav_protection_t", "fusion",
    "how far the fused position may be wrong, along and across the way, by stated risk", "10 Hz");
inline constexpr ChannelSpec self_calibration =
    of_data(channel_names::self_calibration, "self_calibration_t", "fusion",
            "what the filter has estimated of the car and its sensors", "1 Hz");
inline constexpr ChannelSpec visual_odometry =
    of_data(channel_names::visual_odometry, "relative_motion_t", "stereo",
            "relative pose, covariance, quality", "10 Hz");
inline constexpr ChannelSpec lidar_odometry =
    of_data(channel_names::lidar_odometry, "lidar_motion_t", "lidar",
            "relative pose of each scan, degenerate directions, change of its seed", "10 Hz");
inline constexpr ChannelSpec odometry =
    of_data(channel_names::odometry, "relative_motion_t", "lidar",
            "the motion that is fused, and from which sensors", "10 Hz");
inline constexpr ChannelSpec map_match = of_data(
    channel_names::map_match, "map_match_t", "mapmatch",
    "phase, link, matched point, P(link), candidates with their rules, reasons in words", "10 Hz");
inline constexpr ChannelSpec map_doubt = of_data(
    channel_names::map_doubt, "map_doubt_t", "mapmatch",
    "what the drive contradicted of the map: missing road, wrong direction, forbidden turn, "
    "shifted road",
    "on change");
inline constexpr ChannelSpec map_feedback =
    of_data(channel_names::map_feedback, "map_feedback_t", "mapmatch",
            "feedback to the filter, or why there was none", "10 Hz");
inline constexpr ChannelSpec imu =
    of_data(channel_names::imu, "imu_t", "imu", "inertial sample", "the sensor's");
inline constexpr ChannelSpec gnss_fix =
    of_data(channel_names::gnss_fix, "gnss_fix_t", "gnss",
            "position and velocity with covariance, of the receiver or of ppp", "1 Hz");
inline constexpr ChannelSpec ppp_state = of_data(
    channel_names::ppp_state, "ppp_state_t", "ppp",
    "position, covariance, protection levels, satellites and refusals, residuals, convergence",
    "the receiver's");
inline constexpr ChannelSpec wheel_speed =
    of_data(channel_names::wheel_speed, "wheel_speed_t", "wheel", "forward speed of the wheels",
            "the sensor's");
inline constexpr ChannelSpec truth = of_data(channel_names::truth, "reference_pose_t", "reference",
                                             "reference pose, replay only", "10 Hz");
inline constexpr ChannelSpec camera =
    of_data(channel_names::camera, "stereo_pair_t", "camera",
            "rectified pair, unchanged; only in logs", "10 Hz", Reach::log);
inline constexpr ChannelSpec velodyne =
    of_data(channel_names::velodyne, "lidar_scan_t", "velodyne", "scan, unchanged; only in logs",
            "10 Hz", Reach::log);
inline constexpr ChannelSpec preview =
    of_run(channel_names::preview, "preview_t", "preview",
           "small picture with tracks, thinned scan; not in logs", "2 Hz", Reach::viewers);
inline constexpr ChannelSpec calibration =
    of_run(channel_names::calibration, "calibration_t", "publisher", "sensors on the vehicle",
           "at the start");
inline constexpr ChannelSpec replay_control =
    of_run(channel_names::replay_control, "replay_control_t", "player",
           "commands to the player (in), its state (out); not in logs", "on change");
inline constexpr ChannelSpec run =
    of_run(channel_names::run, "run_t", "player",
           "id and description of each publishing run; not in logs", "1 Hz");
inline constexpr ChannelSpec deadlines = of_run(channel_names::deadlines, "deadlines_t", "health",
                                                "latency of each thread and path, misses", "1 Hz");
inline constexpr ChannelSpec health =
    of_run(channel_names::health, "health_t", "health",
           "threads, rings, rates, losses, refusals, real-time settings, degraded modes", "1 Hz");

inline constexpr std::array all{nav_state,
                                odom_state,
                                nav_protection,
                                self_calibration,
                                visual_odometry,
                                lidar_odometry,
                                odometry,
                                map_match,
                                map_doubt,
                                map_feedback,
                                imu,
                                gnss_fix,
                                ppp_state,
                                wheel_speed,
                                truth,
                                camera,
                                velodyne,
                                preview,
                                calibration,
                                replay_control,
                                run,
                                deadlines,
                                health};
}  // namespace channels
}  // namespace maploop::vehicle
