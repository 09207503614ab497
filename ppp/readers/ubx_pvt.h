// A u-blox receiver's own solution: UBX NAV-PVT (u-blox F9 HPG interface description).
#pragma once

#include <Eigen/Core>
#include <string>

#include "msgs/local_frame.h"
#include "ppp/gps_time.h"
#include "ppp/readers/ubx_frames.h"

namespace maploop::ppp {

struct UbxPvt {
  GpsTime time{};
  // In three dimensions, from satellites, within the receiver's own limits. Without it nothing else
  // than the time counts.
  bool fix = false;
  Geodetic position;                                       // on WGS 84's ellipsoid
  Eigen::Vector3d velocity_enu = Eigen::Vector3d::Zero();  // m/s
  double horizontal_sigma = 0.0;                           // m, of the distance in the plane
  double vertical_sigma = 0.0;                             // m
  double speed_sigma = 0.0;                                // m/s, in three dimensions
  int satellites = 0;
};

// Whether `frame` is one whose time is known. `problem` gets what is wrong with one that does not
// hold what it says, and is left alone otherwise.
bool decode_pvt(const UbxFrame& frame, UbxPvt& pvt, std::string& problem);

}  // namespace maploop::ppp
