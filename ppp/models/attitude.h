// Attitude of a satellite and what follows from it: phase wind-up, eclipses.
#pragma once

#include <Eigen/Core>

namespace maploop::ppp {

// Nominal yaw steering: columns are the body's axes in the earth-fixed frame, z to the earth, y
// across the sun (ppp/METHOD.md). m.
Eigen::Matrix3d nominal_attitude(const Eigen::Vector3d& satellite, const Eigen::Vector3d& sun);

// Whether the satellite is in the earth's shadow (a cylinder).
bool in_shadow(const Eigen::Vector3d& satellite, const Eigen::Vector3d& sun);

// Phase wind-up in cycles (Wu and others 1993), the whole cycle next to `before`.
double wind_up(const Eigen::Matrix3d& R_ecef_body, const Eigen::Matrix3d& R_enu_ecef,
               const Eigen::Vector3d& receiver_to_satellite, double before);

}  // namespace maploop::ppp
