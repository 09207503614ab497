// This file reads what the first messages of a bag say of its sensors.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "sensors/bag/camera_messages.h"
#include "sensors/bag/frame_tree.h"
#include "sensors/bag/message_reader.h"
#include "sensors/bag/ros_messages.h"

namespace maploop::sensors {

// Calls use(message) for the messages of some topics that were received from `begin` on and can be
// read, until it returns false. What throws std::invalid_argument is skipped: the source of the
// topic reports it.
void read_first(const std::filesystem::path& path, std::set<std::string> topics, Time begin,
                const std::function<bool(const RecordedMessage&)>& use);

// Returns the header of a message of any sensor. Throws std::invalid_argument.
RosHeader header_of(const RecordedMessage& message);

// Holds what the first messages of a topic say.
struct FirstMessages {
  std::string frame;
  std::vector<Time> headers;  // their stamps
};

FirstMessages first_messages(const std::filesystem::path& path, const Topic& topic);

// Joins the transforms of /tf_static, and the first ones of /tf, because some recordings repeat
// constant ones there.
FrameTree read_frames(const std::filesystem::path& path, const BagSummary& bag);

// Returns the mean of the first samples of an inertial unit, in its axes; zero if there is none.
Eigen::Vector3d mean_force(const std::filesystem::path& path, const Topic& topic);

// Returns the first calibration of two cameras. Throws std::invalid_argument whose text is the
// reason.
RosStereo read_stereo(const std::filesystem::path& path, const Topic& left_info,
                      const Topic& right_info, bool images_are_rectified);

}  // namespace maploop::sensors
