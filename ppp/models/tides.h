// Displacement of a site by tides (IERS Conventions 2010, chapter 7), m in the earth-fixed frame.
#pragma once

#include "ppp/models/earth.h"
#include "ppp/readers/ocean_loading.h"

namespace maploop::ppp {

// Solid earth: second and third degree in phase, and the K1 correction; to about 5 mm.
Eigen::Vector3d solid_earth_tide(const Eigen::Vector3d& site, const SunAndMoon& bodies);

// By the 11 constituents of the station's coefficients, without minor tides.
Eigen::Vector3d ocean_tide(const Eigen::Vector3d& site, const OceanLoading& loading, GpsTime t);

// Zero where the pole is not known.
Eigen::Vector3d pole_tide(const Eigen::Vector3d& site, const SunAndMoon& earth);

// The nearest station of the files within 50 km whose comment gives its place, or the one with the
// marker's name.
const OceanLoading* nearest_station(const std::vector<OceanLoadingFile>& files,
                                    const Eigen::Vector3d& site, const std::string& marker);

}  // namespace maploop::ppp
