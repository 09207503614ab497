// The vehicle's graph in one table: what runs when, when its result becomes available, by when it
// has to be done, which ring joins whom, what goes on which channel. The code, the watchdog and the
// page GRAPH.md are made from it.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "msgs/lcm/channel_names.h"
#include "msgs/time.h"
#include "runtime/core/edge.h"
#include "runtime/core/periodic.h"

namespace maploop::vehicle {

using std::chrono::milliseconds;

// One thread. Rates and periods are of data time; the deadline is of the machine's clock.
struct Stage {
  std::string_view name;
  std::string_view runs;
  std::string_view released;  // by what
  Duration period;            // of a fixed-rate thread, else 0
  Duration budget;            // the result becomes available this long after the release
  Duration deadline;          // from release to result; 0: none
  double min_rate;            // Hz, less is reported on HEALTH; 0: not watched
  double max_rate;            // Hz, more is reported on HEALTH
  // Of a fixed-rate thread: when within its period, and what a live run does with ticks that fall
  // behind. A replay catches up with every tick that data come from: the same bits.
  Duration phase{};
  runtime::Overrun overrun = runtime::Overrun::catch_up;
  // Of a stage with two inputs: how long what came on one waits for what belongs to it on the
  // other; from its own `available`, in data time. Then it goes alone.
  Duration patience{};
};

namespace stages {
inline constexpr Stage camera{"camera", "driver", "sensor", {}, {}, {}, 5.0, 40.0};
inline constexpr Stage velodyne{"velodyne", "driver", "sensor", {}, {}, {}, 5.0, 21.0};
inline constexpr Stage imu{"imu", "driver", "sensor", {}, {}, {}, 5.0, 1000.0};
inline constexpr Stage gnss{"gnss", "driver", "sensor", {}, {}, {}, 0.5, 21.0};
inline constexpr Stage corrections{"corrections", "driver", "sensor", {}, {}, {}, 0.0, 1000.0};
inline constexpr Stage wheel{"wheel", "driver", "sensor", {}, {}, {}, 0.0, 1000.0};
inline constexpr Stage reference{"reference", "driver", "sensor", {}, {}, {}, 0.0, 1000.0};
inline constexpr Stage odometry{
    "odometry", "driver, of a log without images", "sensor", {}, {}, {}, 5.0, 40.0};
inline constexpr Stage visual_log{
    "visual log", "driver, of a log without images", "sensor", {}, {}, {}, 0.0, 40.0};
inline constexpr Stage lidar_log{
    "lidar log", "driver, of a log without images", "sensor", {}, {}, {}, 0.0, 40.0};
inline constexpr Stage stereo{"stereo",         "visual odometry", "image pair", {},
                              milliseconds(50), milliseconds(50),  5.0,          40.0};
inline constexpr Stage lidar{"lidar",
                             "visual-LiDAR odometry",
                             "scan and its visual motion",
                             {},
                             milliseconds(60),
                             milliseconds(60),
                             5.0,
                             40.0,
                             {},
                             runtime::Overrun::catch_up,
                             // A turn of 0.1 s ends at most 45 ms after the odometry of an image
                             // at its begin; the rest is for deliveries.
                             milliseconds(60)};
inline constexpr Stage ppp{
    "ppp", "precise point positioning", "GNSS epoch", {}, milliseconds(10), milliseconds(10), 0.5,
    21.0};
inline constexpr Stage fusion{"fusion",
                              "reduced-IMU filter",
                              "its period",
                              milliseconds(10),
                              milliseconds(1),
                              milliseconds(2),
                              95.0,
                              105.0,
                              {},
                              runtime::Overrun::skip};
inline constexpr Stage mapmatch{"mapmatch",
                                "map matching",
                                "its period",
                                milliseconds(100),
                                milliseconds(2),
                                milliseconds(2),
                                9.5,
                                10.5,
                                fusion.budget,  // when the state of a tick of the fusion is there
                                runtime::Overrun::skip};
inline constexpr Stage publisher{"publisher", "LCM, log", "looks by itself", {}, {}, {}, 0.0, 0.0};
inline constexpr Stage health{
    "health", "watchdog, histograms", "its period",          std::chrono::seconds(1), {}, {}, 0.0,
    0.0,      milliseconds(5),        runtime::Overrun::skip};  // between two ticks of the fusion

inline constexpr Stage preview{"preview", "pictures for people", "its rate", {}, {}, {}, 0.0, 0.0};

inline constexpr Stage player{
    "player", "keys, commands of a replay", "looks by itself", {}, {}, {}, 0.0, 0.0};
inline constexpr Stage snapshot{
    "snapshot", "joins what stages save", "their parts", {}, {}, {}, 0.0, 0.0};

inline constexpr std::array all{camera,    velodyne,  imu,      gnss,       corrections,
                                wheel,     reference, odometry, visual_log, lidar_log,
                                stereo,    lidar,     ppp,      fusion,     mapmatch,
                                publisher, health,    player,   snapshot,   preview};
}  // namespace stages

// One ring: single producer, single consumer. A replay keeps all: a full ring holds its producer
// up, and with it the data clock.
struct EdgeSpec {
  std::string_view name;
  std::string_view carries;
  std::size_t capacity;  // samples: few where they are large, seconds of data where they are small
  runtime::Overflow overflow = runtime::Overflow::keep_all;
};

namespace edges {
inline constexpr EdgeSpec camera_stereo{"camera -> stereo", "StereoPair", 4};
// Only there where the odometry is visual-LiDAR.
inline constexpr EdgeSpec velodyne_lidar{"velodyne -> lidar", "LidarScan", 4};
inline constexpr EdgeSpec stereo_lidar{"stereo -> lidar", "VisualMotion", 256};
inline constexpr EdgeSpec imu_fusion{"imu -> fusion", "ImuSample", 256};
// Only there where the receiver's observations are recorded instead of its fixes.
inline constexpr EdgeSpec gnss_ppp{"gnss -> ppp", "GnssEpoch", 64};
// Only there where a live receiver's observations are corrected by a stream.
inline constexpr EdgeSpec corrections_ppp{"corrections -> ppp", "GnssCorrections", 256};
// From ppp instead where there are observations, and so to the publisher.
inline constexpr EdgeSpec gnss_fusion{"gnss -> fusion", "GnssFix", 256};
inline constexpr EdgeSpec wheel_fusion{"wheel -> fusion", "WheelSpeed", 256};
// From stereo instead where `odometry` is "visual" or there is no LiDAR.
inline constexpr EdgeSpec odometry_fusion{"lidar -> fusion", "RelativeMotion", 256};
// Only there where there is a map.
inline constexpr EdgeSpec fusion_mapmatch{"fusion -> mapmatch", "NavState", 256};
inline constexpr EdgeSpec stereo_mapmatch{"stereo -> mapmatch", "RelativeMotion", 256};
// Only there where the loop is closed.
inline constexpr EdgeSpec mapmatch_fusion{"mapmatch -> fusion", "MapFeedback", 16};
inline constexpr EdgeSpec mapmatch_ppp{"mapmatch -> ppp", "MapFeedback", 16};
// Only there where a log of raw sensors is written.
inline constexpr EdgeSpec camera_publisher{"camera -> publisher", "StereoPair", 4};
inline constexpr EdgeSpec velodyne_publisher{"velodyne -> publisher", "LidarScan", 4};
inline constexpr EdgeSpec imu_publisher{"imu -> publisher", "ImuSample", 256};
inline constexpr EdgeSpec gnss_publisher{"gnss -> publisher", "GnssFix", 256};
inline constexpr EdgeSpec wheel_publisher{"wheel -> publisher", "WheelSpeed", 256};
inline constexpr EdgeSpec reference_publisher{"reference -> publisher", "ReferencePose", 256};
inline constexpr EdgeSpec stereo_publisher{"stereo -> publisher", "RelativeMotion", 256};
inline constexpr EdgeSpec lidar_publisher{"lidar -> publisher", "LidarMotion", 256};
inline constexpr EdgeSpec ppp_publisher{"ppp -> publisher", "PppState", 64};
inline constexpr EdgeSpec odometry_publisher{"lidar, odometry -> publisher", "RelativeMotion", 256};
inline constexpr EdgeSpec fusion_publisher{"fusion -> publisher", "NavState", 1024};
inline constexpr EdgeSpec image_states{"fusion at images -> publisher", "NavState", 256};
inline constexpr EdgeSpec mapmatch_publisher{"mapmatch -> publisher", "MapMatch", 64};
inline constexpr EdgeSpec feedback_publisher{"mapmatch feedback -> publisher", "MapFeedback", 64};
// Only there where somebody may look on.
inline constexpr EdgeSpec preview_publisher{"preview -> publisher", "Preview", 2,
                                            runtime::Overflow::drop_newest};
inline constexpr EdgeSpec health_publisher{"health -> publisher", "RuntimeReport", 8};
// Only there where snapshots are taken.
inline constexpr EdgeSpec stereo_snapshot{"stereo -> snapshot", "StageSnapshot", 2};
inline constexpr EdgeSpec lidar_snapshot{"lidar -> snapshot", "StageSnapshot", 2};
inline constexpr EdgeSpec ppp_snapshot{"ppp -> snapshot", "StageSnapshot", 2};
inline constexpr EdgeSpec fusion_snapshot{"fusion -> snapshot", "StageSnapshot", 2};
inline constexpr EdgeSpec mapmatch_snapshot{"mapmatch -> snapshot", "StageSnapshot", 2};

inline constexpr std::array all{camera_stereo,      velodyne_lidar,     stereo_lidar,
                                imu_fusion,         gnss_ppp,           corrections_ppp,
                                gnss_fusion,        ppp_publisher,      ppp_snapshot,
                                wheel_fusion,       odometry_fusion,    fusion_mapmatch,
                                stereo_mapmatch,    mapmatch_fusion,    mapmatch_ppp,
                                camera_publisher,   velodyne_publisher, imu_publisher,
                                gnss_publisher,     wheel_publisher,    reference_publisher,
                                stereo_publisher,   lidar_publisher,    odometry_publisher,
                                fusion_publisher,   image_states,       mapmatch_publisher,
                                feedback_publisher, preview_publisher,  health_publisher,
                                stereo_snapshot,    lidar_snapshot,     fusion_snapshot,
                                mapmatch_snapshot};
}  // namespace edges

template <class T>
runtime::Edge<T> make_edge(const EdgeSpec& spec, runtime::Doorbell* bell) {
  return runtime::Edge<T>(std::string(spec.name), spec.capacity, spec.overflow, bell);
}

// Whom a channel goes to, for some only those who want it (message_sink.h).
enum class Reach {
  everyone,
  log,      // too large for the network
  lookers,  // people, for whom it is made small
};

// What a thread gives to another that asks for it: newest value wins, nobody waits.
struct CellSpec {
  std::string_view name;
  std::string_view carries;
};

namespace cells {
inline constexpr std::array all{CellSpec{"stereo -> preview", "PreviewImage"},
                                CellSpec{"lidar -> preview", "PreviewScan"}};
}  // namespace cells

// One LCM channel.
struct Channel {
  std::string_view name;
  std::string_view type;  // in msgs/lcm
  std::string_view from;  // stage
  std::string_view shows;
  std::string_view rate;
  bool from_data;  // derived from data alone: hashed, and the same bits in each run
  Reach reach = Reach::everyone;
};

namespace channels {
inline constexpr Channel nav_state{channel_names::nav_state,
                                   "nav_state_t",
                                   "fusion",
                                   "fused position, velocity, attitude, covariance",
                                   "100 Hz",
                                   true};
inline constexpr Channel visual_odometry{channel_names::visual_odometry,
                                         "relative_motion_t",
                                         "stereo",
                                         "relative pose, covariance, quality",
                                         "10 Hz",
                                         true};
inline constexpr Channel lidar_odometry{
    channel_names::lidar_odometry,
    "lidar_motion_t",
    "lidar",
    "relative pose of each scan, degenerate directions, what it changed in its seed",
    "10 Hz",
    true};
inline constexpr Channel odometry{channel_names::odometry,
                                  "relative_motion_t",
                                  "lidar",
                                  "the motion that fusion gets, and from which sensors",
                                  "10 Hz",
                                  true};
inline constexpr Channel map_match{
    channel_names::map_match,
    "map_match_t",
    "mapmatch",
    "phase, link, matched point, P(link), candidates with their rules, reasons in words",
    "10 Hz",
    true};
inline constexpr Channel map_feedback{channel_names::map_feedback,
                                      "map_feedback_t",
                                      "mapmatch",
                                      "what was fed back to the filter, or why nothing",
                                      "10 Hz",
                                      true};
inline constexpr Channel imu{channel_names::imu, "imu_t",        "imu",
                             "inertial sample",  "the sensor's", true};
inline constexpr Channel gnss_fix{channel_names::gnss_fix,
                                  "gnss_fix_t",
                                  "gnss",
                                  "position and velocity with covariance; of observations: ppp's",
                                  "1 Hz",
                                  true};
inline constexpr Channel ppp_state{
    channel_names::ppp_state,
    "ppp_state_t",
    "ppp",
    "position, covariance, protection levels, satellites and why not, residuals, convergence",
    "the receiver's",
    true};
inline constexpr Channel wheel_speed{channel_names::wheel_speed,    "wheel_speed_t", "wheel",
                                     "forward speed of the wheels", "the sensor's",  true};
inline constexpr Channel truth{channel_names::truth,
                               "reference_pose_t",
                               "reference",
                               "reference pose, replay only",
                               "10 Hz",
                               true};
inline constexpr Channel camera{channel_names::camera,
                                "stereo_pair_t",
                                "camera",
                                "rectified pair, as it is; only in logs",
                                "10 Hz",
                                true,
                                Reach::log};
inline constexpr Channel velodyne{channel_names::velodyne,
                                  "lidar_scan_t",
                                  "velodyne",
                                  "scan, as it is; only in logs",
                                  "10 Hz",
                                  true,
                                  Reach::log};
inline constexpr Channel preview{channel_names::preview,
                                 "preview_t",
                                 "preview",
                                 "small picture with tracks, thinned scan; not in logs",
                                 "2 Hz",
                                 false,
                                 Reach::lookers};
inline constexpr Channel calibration{channel_names::calibration, "calibration_t", "publisher",
                                     "sensors on the vehicle",   "at the start",  false};
inline constexpr Channel replay_control{channel_names::replay_control,
                                        "replay_control_t",
                                        "player",
                                        "commands to the player (in), its state (out); not in logs",
                                        "on change",
                                        false};
inline constexpr Channel run{channel_names::run,
                             "run_t",
                             "player",
                             "who publishes here, a vehicle too: id, what it is; not in logs",
                             "1 Hz",
                             false};
inline constexpr Channel deadlines{channel_names::deadlines,
                                   "deadlines_t",
                                   "health",
                                   "latency of each thread and path, misses",
                                   "1 Hz",
                                   false};
inline constexpr Channel health{
    channel_names::health,
    "health_t",
    "health",
    "threads, rings, rates, losses, refusals, real-time settings, degraded modes",
    "1 Hz",
    false};

inline constexpr std::array all{
    nav_state, visual_odometry, lidar_odometry, odometry,       map_match, map_feedback,
    imu,       gnss_fix,        ppp_state,      wheel_speed,    truth,     camera,
    velodyne,  preview,         calibration,    replay_control, run,       deadlines,
    health};
}  // namespace channels

// From a sensor's stamp to the state that holds it. The deadline is the sum of what may pass on the
// way: the sensor's own delay, the budgets, the wait for a scan, one period of waiting for the
// tick, and its deadline.
struct Path {
  std::string_view name;
  Duration deadline;
};

namespace paths {
inline constexpr Duration camera_delay = milliseconds(10);  // exposure and readout
inline constexpr Duration imu_delay = milliseconds(62);     // filters inside the sensor, delivery
inline constexpr Path camera{"camera stamp -> state",
                             camera_delay + stages::stereo.budget + stages::lidar.patience +
                                 stages::lidar.budget + stages::fusion.period +
                                 stages::fusion.deadline};
inline constexpr Path imu{"imu stamp -> state",
                          imu_delay + stages::fusion.period + stages::fusion.deadline};
inline constexpr std::array all{camera, imu};
}  // namespace paths

// The table as a Markdown page.
std::string graph_page();

}  // namespace maploop::vehicle
