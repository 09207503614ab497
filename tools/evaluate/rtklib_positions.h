// Reads the positions that RTKLIB writes, and other programs after it.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "ppp/gps_time.h"

namespace maploop::evaluation {

struct RtklibPosition {
  ppp::GpsTime time{};
  Eigen::Vector3d place{0, 0, 0};  // m, earth-fixed
  int quality = 0;                 // 1: fixed; 0: not given
};

// Reads a plain or .gz file, whose heading says its time, GPST or UTC, and its coordinates, XYZ or
// degrees. Throws std::runtime_error naming the file if it is not so, the times do not
// increase, or there is no position.
std::vector<RtklibPosition> read_rtklib_positions(const std::filesystem::path& file);

}  // namespace maploop::evaluation
