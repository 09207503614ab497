#include "sensors/folder/sequence_calibration.h"

#include <stdexcept>
#include <string>
#include <vector>

#include "msgs/input_limits.h"
#include "msgs/vehicle_description.h"
#include "sensors/image/jpeg.h"
#include "sensors/image/png.h"
#include "sensors/image/video_file.h"
#include "sensors/replay/files.h"
#include "sensors/replay/keyed_text.h"

namespace maploop::sensors {
namespace {

namespace fs = std::filesystem;

// Returns the first image of a camera, which has the size of all.
GreyImage first_image(const ImageFolder& images) {
  GreyImage first;
  if (has_video_name(images.data)) {
    try {
      if (VideoFile(images.data).read(0, first)) return first;
    } catch (const std::runtime_error& error) {
      throw std::runtime_error("'" + images.data.string() + "': " + error.what());
    }
    throw std::runtime_error("the video '" + images.data.string() + "' has no image");
  }
  std::vector<char> bytes;
  read_bytes(images.data / images.names.at(0), input_limits::picture, bytes);
  return is_png(bytes) ? decode_any_png(bytes) : decode_grey_jpeg(bytes);
}

}  // namespace

VehicleCalibration read_sequence_calibration(const fs::path& file, const ImageFolder& images) {
  const std::string content = read_calibration_text(file);
  const KeyedText text(content, file);
  const std::vector<double> left = text.numbers("P0", 12), right = text.numbers("P1", 12);
  for (const std::size_t i : {0U, 2U, 5U, 6U})
    if (left[i] != right[i]) text.fail("P1", "has intrinsics that differ from P0");
  StereoCalibration stereo;
  stereo.fx = left[0];
  stereo.fy = left[5];
  stereo.cx = left[2];
  stereo.cy = left[6];
  stereo.baseline = left[0] > 0.0 ? -right[3] / left[0] : 0.0;
  if (!(left[0] >= 1.0 && left[0] <= 1e5 && left[5] >= 1.0 && left[5] <= 1e5))
    text.fail("P0", "has a focal length outside 1 to 100000 pixels");
  if (!(stereo.baseline > 0.01 && stereo.baseline < 10.0))
    text.fail("P1", "gives a baseline outside 0.01 to 10 m");
  const GreyImage first = first_image(images);
  stereo.width = first.width;
  stereo.height = first.height;
  stereo.T_body_cam = maploop::camera_pose({}, {});
  VehicleCalibration calibration;
  calibration.stereo = stereo;
  calibration.T_body_velo = stereo.T_body_cam;
  if (content.find("Tr:") != std::string::npos)
    calibration.T_body_velo = stereo.T_body_cam * text.rigid("Tr");
  return calibration;
}

}  // namespace maploop::sensors
