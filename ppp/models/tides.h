// Computes the displacement of a site by tides (IERS Conventions 2010, chapter 7). All vectors are
// in m in the earth-fixed frame.
#pragma once

#include "ppp/models/earth.h"
#include "ppp/readers/files/ocean_loading.h"

namespace maploop::ppp {

// The tide of the solid earth is that of second and third degree in phase with the K1 correction;
// it is accurate to about 5 mm.
Eigen::Vector3d solid_earth_tide(const Eigen::Vector3d& site, const SunAndMoon& bodies);

// The ocean tide consists of the 11 constituents of the station's coefficients, without minor
// tides.
Eigen::Vector3d ocean_tide(const Eigen::Vector3d& site, const OceanLoading& loading, GpsTime t);

// The pole tide is zero if the pole is unknown.
Eigen::Vector3d pole_tide(const Eigen::Vector3d& site, const SunAndMoon& earth);

// Returns the station whose name starts with the first four characters of the marker, or else the
// nearest one whose comment gives its coordinates, within 50 km; nullptr if there is none.
const OceanLoading* nearest_station(const std::vector<OceanLoadingFile>& files,
                                    const Eigen::Vector3d& site, const std::string& marker);

}  // namespace maploop::ppp
