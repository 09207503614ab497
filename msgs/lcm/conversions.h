// This file converts samples, results and diagnostics to LCM types and back. Nothing is lost but
// `received`, which belongs to this machine, and the words of a match, which are for people.
#pragma once

#include <maploop_lcm/calibration_t.hpp>
#include <maploop_lcm/deadlines_t.hpp>
#include <maploop_lcm/gnss_fix_t.hpp>
#include <maploop_lcm/health_t.hpp>
#include <maploop_lcm/imu_t.hpp>
#include <maploop_lcm/lidar_motion_t.hpp>
#include <maploop_lcm/lidar_scan_t.hpp>
#include <maploop_lcm/map_doubt_t.hpp>
#include <maploop_lcm/map_feedback_t.hpp>
#include <maploop_lcm/map_match_t.hpp>
#include <maploop_lcm/nav_protection_t.hpp>
#include <maploop_lcm/nav_state_t.hpp>
#include <maploop_lcm/odom_state_t.hpp>
#include <maploop_lcm/ppp_state_t.hpp>
#include <maploop_lcm/preview_t.hpp>
#include <maploop_lcm/reference_pose_t.hpp>
#include <maploop_lcm/relative_motion_t.hpp>
#include <maploop_lcm/self_calibration_t.hpp>
#include <maploop_lcm/stereo_pair_t.hpp>
#include <maploop_lcm/wheel_speed_t.hpp>

#include "msgs/calibration.h"
#include "msgs/diagnostics.h"
#include "msgs/gnss.h"
#include "msgs/image.h"
#include "msgs/imu.h"
#include "msgs/lidar_scan.h"
#include "msgs/map_doubt.h"
#include "msgs/map_feedback.h"
#include "msgs/map_match.h"
#include "msgs/nav_protection.h"
#include "msgs/nav_state.h"
#include "msgs/odom_state.h"
#include "msgs/odometry.h"
#include "msgs/ppp_state.h"
#include "msgs/preview.h"
#include "msgs/reference.h"
#include "msgs/wheel_speed.h"

namespace maploop {

maploop_lcm::nav_state_t to_lcm(const NavState& state);
maploop_lcm::odom_state_t to_lcm(const OdomState& state);
maploop_lcm::nav_protection_t to_lcm(const NavProtection& protection);
maploop_lcm::relative_motion_t to_lcm(const RelativeMotion& motion);
maploop_lcm::lidar_motion_t to_lcm(const LidarMotion& motion);
maploop_lcm::imu_t to_lcm(const ImuSample& sample);
maploop_lcm::wheel_speed_t to_lcm(const WheelSpeed& sample);
maploop_lcm::gnss_fix_t to_lcm(const GnssFix& fix);
maploop_lcm::ppp_state_t to_lcm(const PppState& state);
maploop_lcm::reference_pose_t to_lcm(const ReferencePose& pose);
maploop_lcm::map_match_t to_lcm(const MapMatch& match, const MapMatchWords& words);
maploop_lcm::map_doubt_t to_lcm(const MapDoubt& doubt);
maploop_lcm::map_feedback_t to_lcm(const MapFeedback& feedback);
maploop_lcm::preview_t to_lcm(const Preview& preview);
maploop_lcm::deadlines_t to_lcm(const Deadlines& deadlines);
maploop_lcm::self_calibration_t to_lcm(const SelfCalibration& calibration);
maploop_lcm::health_t to_lcm(const Health& health);
maploop_lcm::calibration_t to_lcm(const VehicleCalibration& calibration);  // the caller sets utime
maploop_lcm::stereo_pair_t to_lcm(const StereoPair& pair);
maploop_lcm::lidar_scan_t to_lcm(const LidarScan& scan);

// These throw std::invalid_argument if the struct cannot hold a value: an unknown status, more
// candidates than a match has, a size that contradicts the rest.
NavState from_lcm(const maploop_lcm::nav_state_t& message);
OdomState from_lcm(const maploop_lcm::odom_state_t& message);
NavProtection from_lcm(const maploop_lcm::nav_protection_t& message);
RelativeMotion from_lcm(const maploop_lcm::relative_motion_t& message);
LidarMotion from_lcm(const maploop_lcm::lidar_motion_t& message);
ImuSample from_lcm(const maploop_lcm::imu_t& message);
WheelSpeed from_lcm(const maploop_lcm::wheel_speed_t& message);
GnssFix from_lcm(const maploop_lcm::gnss_fix_t& message);
PppState from_lcm(const maploop_lcm::ppp_state_t& message);
ReferencePose from_lcm(const maploop_lcm::reference_pose_t& message);
MapMatch from_lcm(const maploop_lcm::map_match_t& message);
MapDoubt from_lcm(const maploop_lcm::map_doubt_t& message);
MapFeedback from_lcm(const maploop_lcm::map_feedback_t& message);
Preview from_lcm(const maploop_lcm::preview_t& message);
Deadlines from_lcm(const maploop_lcm::deadlines_t& message);
SelfCalibration from_lcm(const maploop_lcm::self_calibration_t& message);
Health from_lcm(const maploop_lcm::health_t& message);
VehicleCalibration from_lcm(const maploop_lcm::calibration_t& message);
// The output's buffers are reused.
void from_lcm(const maploop_lcm::stereo_pair_t& message, StereoPair& pair);
void from_lcm(const maploop_lcm::lidar_scan_t& message, LidarScan& scan);

}  // namespace maploop
