// Decodes a u-blox receiver's own solution, UBX NAV-PVT (u-blox F9 HPG interface description).
#pragma once

#include <Eigen/Core>
#include <string>

#include "msgs/local_frame.h"
#include "ppp/gps_time.h"
#include "ppp/readers/streams/ubx_frames.h"

namespace maploop::ppp {

struct UbxPvt {
  GpsTime time{};
  // True for a solution in three dimensions from satellites, within the receiver's own limits.
  // Otherwise only the time is valid.
  bool fix = false;
  Geodetic position;                                       // on the ellipsoid of WGS 84
  Eigen::Vector3d velocity_enu = Eigen::Vector3d::Zero();  // m/s
  double horizontal_sigma = 0.0;  // m, of the distance in the horizontal plane
  double vertical_sigma = 0.0;    // m
  double speed_sigma = 0.0;       // m/s, in three dimensions
  int satellites = 0;
};

// Returns whether `frame` is a NAV-PVT message with a known time and valid content; `pvt.fix` tells
// whether it has a solution. `problem` is set to what is wrong with the content, and stays
// unchanged otherwise.
bool decode_pvt(const UbxFrame& frame, UbxPvt& pvt, std::string& problem);

}  // namespace maploop::ppp
