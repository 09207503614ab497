// This file finds which topic of a recording is which sensor of the vehicle.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "msgs/named_enum.h"
#include "sensors/bag/message_reader.h"

namespace maploop::sensors {

enum class BagSensor : std::uint8_t {
  camera_left,
  camera_right,
  camera_left_info,  // what describes the camera
  camera_right_info,
  lidar,
  imu,
  gnss,
  gnss_velocity,
  gnss_raw,        // a receiver's observations
  gnss_subframes,  // the messages of satellites that it passes on
  wheel
};

constexpr auto names_of(BagSensor) {
  return names_up_to<BagSensor::wheel>({"camera.left", "camera.right", "camera.left_info",
                                        "camera.right_info", "lidar", "imu", "gnss",
                                        "gnss.velocity", "gnss.raw", "gnss.subframes", "wheel"});
}

struct TopicChoice {
  std::map<BagSensor, Topic> topics;
  std::vector<std::string> notes;  // a sentence for each topic of a sensor that is not used

  const Topic* find(BagSensor sensor) const {
    const auto found = topics.find(sensor);
    return found == topics.end() ? nullptr : &found->second;
  }
};

// Chooses a topic for each sensor of the recording at `path`. `given` has texts SENSOR=TOPIC; with
// the topic "none" the sensor is not used. The rules, for what is not given:
// - The LiDAR, the inertial unit, the receiver's fixes, observations and subframes are the only
//   topic of their type. The packets of a Velodyne scanner are taken where there are no clouds.
// - The cameras are two topics of images whose names differ by left and right, or by 0 and 1, only.
//   Where there are more such pairs, rectified ones are preferred to raw ones, and grey ones to
//   colours.
// - An image's calibration is the topic camera_info beside it.
// - gnss.velocity (east north up) and wheel (forward speed: x of the vehicle) are used only if they
//   are given, because the type of their messages does not tell what they are.
// Throws std::runtime_error that names the recording, lists the candidates and states what to do if
// several topics could be a sensor, and if a given text is none of these or names a topic that is
// not there or that cannot be decoded.
TopicChoice choose_topics(const std::filesystem::path& path, const BagSummary& bag,
                          const std::vector<std::string>& given);

}  // namespace maploop::sensors
