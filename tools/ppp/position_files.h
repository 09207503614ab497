// Positions in the formats that other programs read.
#pragma once

#include <string>
#include <vector>

#include "ppp/filter/solution.h"

namespace maploop::gnss {

// What is kept of each epoch.
using Solutions = std::vector<ppp::PppSolution>;

// RTKLIB's .pos: latitude, longitude and height, or XYZ; quality 6 (PPP). Epochs without a position
// are left out.
std::string to_pos(const Solutions& solutions, bool ecef, const std::string& observations);

// NMEA 0183: GGA, RMC and GST of each epoch, UTC. Heights are above the ellipsoid: the geoid's
// separation is left empty.
std::string to_nmea(const Solutions& solutions);

// The way as one line: GeoJSON (RFC 7946) and KML 2.2.
std::string to_geojson(const Solutions& solutions);
std::string to_kml(const Solutions& solutions);

// A row for each satellite of each epoch.
std::string to_residual_csv(const Solutions& solutions);

}  // namespace maploop::gnss
