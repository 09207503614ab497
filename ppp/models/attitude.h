// Models the attitude of a satellite and its effects: phase wind-up and eclipses.
#pragma once

#include <Eigen/Core>

namespace maploop::ppp {

// Returns the attitude of nominal yaw steering (ppp/METHOD.md): the columns are the body's axes in
// the earth-fixed frame, with z towards the earth and y perpendicular to the sun's direction.
// `satellite` and `sun` are in m, earth-fixed.
Eigen::Matrix3d nominal_attitude(const Eigen::Vector3d& satellite, const Eigen::Vector3d& sun);

// Returns whether the satellite is in the earth's shadow, modelled as a cylinder.
bool in_shadow(const Eigen::Vector3d& satellite, const Eigen::Vector3d& sun);

// Returns the phase wind-up in cycles (Wu and others 1993), with the whole cycles that bring it
// closest to `before`.
double wind_up(const Eigen::Matrix3d& R_ecef_body, const Eigen::Matrix3d& R_enu_ecef,
               const Eigen::Vector3d& receiver_to_satellite, double before);

}  // namespace maploop::ppp
