// Converts what the vehicle sends to what viewers show on a map and in a scene, whatever the format
// in which a viewer is given it.
#pragma once

#include <functional>
#include <string_view>
#include <variant>

#include "msgs/imu.h"
#include "msgs/lcm/log/log_event.h"
#include "msgs/lcm/schema.h"
#include "tools/log/foxglove_schemas.h"

namespace maploop::lcm_log {

using View =
    std::variant<foxglove::LocationFix, foxglove::PoseInFrame, foxglove::FrameTransform,
                 foxglove::CompressedImage, foxglove::PointCloud, foxglove::SceneUpdate, ImuSample>;

// Calls use(topic, view) for each topic that shows what an event contains; the view is valid during
// the call:
//   NAV_STATE    /map/fix LocationFix of the inertial unit, /map/pose PoseInFrame "map" (east,
//                north, up from the drive's origin), and /tf FrameTransform from "map" to "body"
//                and to "body_enu", which is at the body and has the axes of "map"
//   ODOM_STATE   /odom/pose PoseInFrame "odom"
//   MAP_MATCH    /map/road SceneUpdate (match_scene.h)
//   GNSS_FIX     /gnss/fix LocationFix
//   TRUTH        /truth/fix LocationFix
//   IMU          /imu ImuSample
//   CALIBRATION  /tf_static FrameTransform from "body" to "cam" and to "velo"
//   CAMERA       /camera/left and /camera/right CompressedImage (JPEG)
//   VELODYNE     /velodyne PointCloud
// An event that is none of these, or that has no position yet, shows nothing.
void view(const LogEvent& event, const schema::Schema& schema,
          const std::function<void(std::string_view topic, const View&)>& use);

}  // namespace maploop::lcm_log
