// Computes the positions of sun and moon and the earth's rotation at an epoch (ERFA, the IAU's
// routines).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "ppp/gps_time.h"
#include "ppp/readers/files/earth_rotation.h"

namespace maploop::ppp {

struct SunAndMoon {
  Eigen::Vector3d sun{0, 0, 0}, moon{0, 0, 0};  // m, earth-fixed
  double sidereal_angle = 0.0;                  // rad, Greenwich
  double x_pole = 0.0, y_pole = 0.0;            // rad; zero if no file contains them
  double mjd_ut1 = 0.0;
  bool has_pole = false;
};

// Computes the slow parts once per minute of data and rotates them with the earth in between. The
// result of at() is valid until the next call.
class Earth {
 public:
  explicit Earth(const std::vector<EarthRotationFile>& files);

  const SunAndMoon& at(GpsTime t);

 private:
  EarthRotation rotation_at(double mjd_utc) const;

  std::vector<EarthRotation> days_;
  GpsTime slow_time_{GpsTime::min()};
  Eigen::Matrix3d celestial_to_intermediate_;
  Eigen::Vector3d sun_, moon_;  // m, celestial
  SunAndMoon now_;
};

}  // namespace maploop::ppp
