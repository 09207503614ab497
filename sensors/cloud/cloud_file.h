// This file reads and writes point clouds as .pcd (the format of PCL) and .ply.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/lidar_scan.h"

namespace maploop::sensors {

struct Cloud {
  std::vector<LidarPoint> points;  // reflectance as in the file; 0 if it has none
  std::vector<double> times;       // one a point, as in the file; empty if it has none
};

// Reads a .pcd (ascii, binary, binary_compressed) or .ply (ascii, binary of either byte order),
// which are distinguished by content. Fields x, y and z are needed; intensity, reflectance or
// reflectivity, and time, t or timestamp are read if they exist; others are ignored. Points that
// are not finite are dropped. Throws std::runtime_error whose text is the place (line or byte of
// the file) and the reason.
Cloud parse_cloud(std::string_view content);

// Reads such a file, plain or .gz. Throws FileError.
Cloud read_cloud(const std::filesystem::path& file);

enum class CloudEncoding : std::uint8_t { ascii, binary, compressed };
constexpr std::array<std::string_view, 3> names_of(CloudEncoding) {
  return {"ascii", "binary", "compressed"};
}

// Holds the numbers of each point, row by row.
struct CloudTable {
  std::vector<std::string> fields;  // as PCL names them: x y z, intensity, time, normal_x ...
  std::vector<float> values;
};

// Throws std::runtime_error that names the file unless encode_cloud() can make it: a .pcd, or a
// .ply that is not compressed.
void check_cloud_name(const std::filesystem::path& file, CloudEncoding encoding);

// Returns the content of a file with this name.
std::string encode_cloud(const CloudTable& cloud, const std::filesystem::path& file,
                         CloudEncoding encoding);

}  // namespace maploop::sensors
