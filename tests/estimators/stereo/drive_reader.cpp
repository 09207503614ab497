#include "tests/estimators/stereo/drive_reader.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <stdexcept>

namespace maploop::testing {
namespace {

std::vector<double> read_entry(const std::filesystem::path& file, const std::string& key) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with(key + ":")) continue;
    std::istringstream numbers(line.substr(key.size() + 1));
    std::vector<double> values;
    for (double value; numbers >> value;) values.push_back(value);
    return values;
  }
  throw std::runtime_error(file.string() + ": no entry " + key);
}

Eigen::Matrix3d matrix(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data());
}

Eigen::Isometry3d read_transform(const std::filesystem::path& file) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = Eigen::Quaterniond(matrix(read_entry(file, "R"))).toRotationMatrix();
  transform.translation() = Eigen::Map<const Eigen::Vector3d>(read_entry(file, "T").data());
  return transform;
}

std::vector<Time> read_stamps(const std::filesystem::path& file) {
  std::vector<Time> stamps;
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(file.string() + ": cannot be read");
  for (std::string line; std::getline(stream, line) && !line.empty();)
    stamps.push_back(parse_time(line));
  return stamps;
}

GreyImage read_image(const std::filesystem::path& folder, std::size_t index) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "data/%010zu.png", index);
  const cv::Mat decoded = cv::imread((folder / name.data()).string(), cv::IMREAD_GRAYSCALE);
  if (decoded.empty()) throw std::runtime_error((folder / name.data()).string() + ": no image");
  GreyImage image;
  image.resize(decoded.cols, decoded.rows);
  std::copy(decoded.begin<unsigned char>(), decoded.end<unsigned char>(), image.pixels.begin());
  return image;
}

}  // namespace

StereoCalibration read_stereo_calibration(const std::filesystem::path& folder) {
  const std::filesystem::path cameras = folder / "calib_cam_to_cam.txt";
  const std::vector<double> left = read_entry(cameras, "P_rect_00");
  const std::vector<double> right = read_entry(cameras, "P_rect_01");
  const std::vector<double> size = read_entry(cameras, "S_rect_00");
  StereoCalibration calibration;
  calibration.width = static_cast<int>(size[0]);
  calibration.height = static_cast<int>(size[1]);
  calibration.fx = left[0];
  calibration.fy = left[5];
  calibration.cx = left[2];
  calibration.cy = left[6];
  calibration.baseline = (left[3] - right[3]) / left[0];
  Eigen::Isometry3d rectify = Eigen::Isometry3d::Identity();
  rectify.linear() =
      Eigen::Quaterniond(matrix(read_entry(cameras, "R_rect_00"))).toRotationMatrix();
  const Eigen::Isometry3d T_cam_body = rectify * read_transform(folder / "calib_velo_to_cam.txt") *
                                       read_transform(folder / "calib_imu_to_velo.txt");
  calibration.T_body_cam = T_cam_body.inverse();
  return calibration;
}

std::vector<StereoPair> read_stereo_pairs(const std::filesystem::path& drive, std::size_t count) {
  const std::vector<Time> left = read_stamps(drive / "image_00" / "timestamps.txt");
  const std::vector<Time> right = read_stamps(drive / "image_01" / "timestamps.txt");
  std::vector<StereoPair> pairs(std::min({left.size(), right.size(), count}));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i].stamp = left[i];
    pairs[i].right_stamp = right[i];
    pairs[i].available = std::max(left[i], right[i]);
    pairs[i].sequence = i;
    pairs[i].left = read_image(drive / "image_00", i);
    pairs[i].right = read_image(drive / "image_01", i);
  }
  return pairs;
}

}  // namespace maploop::testing
