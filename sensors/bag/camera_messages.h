// This file converts the images of ROS and what describes their cameras.
#pragma once

#include <optional>
#include <string_view>

#include "msgs/calibration.h"
#include "msgs/image.h"
#include "sensors/bag/ros_messages.h"
#include "sensors/camera/stereo_rig.h"

namespace maploop::sensors {

// Converts an image to grey. Encodings are those of sensor_msgs/image_encodings.h: mono8, mono16,
// 8UC1, 16UC1 (the upper byte), rgb8, bgr8, rgba8, bgra8 (luma of ITU-R BT.601), and bayer_*8, for
// which each pixel becomes the mean of its 3 x 3 neighbourhood, in which red, green and blue weigh
// 1/4, 1/2 and 1/4 at every phase of the pattern. Throws std::invalid_argument whose text is the
// reason: another encoding, a size beyond input_limits::pixels, too few bytes.
void to_grey(const RosImage& image, GreyImage& grey);

// Decodes JPEG and PNG, which are told apart by content. Throws std::runtime_error or
// std::invalid_argument whose text is the reason.
void to_grey(const RosCompressedImage& image, GreyImage& grey);

struct RosStereo {
  StereoCalibration rectified;   // T_body_cam is not set
  std::optional<StereoRig> raw;  // nothing: the images are rectified
};

// Returns what two messages say of a stereo pair. The images are rectified if
// `images_are_rectified` or if there is no distortion to remove. Throws std::invalid_argument whose
// text is the reason: not calibrated, not calibrated as a pair, a distortion that is not plumb_bob.
RosStereo stereo_of(const RosCameraInfo& left, const RosCameraInfo& right,
                    bool images_are_rectified);

}  // namespace maploop::sensors
