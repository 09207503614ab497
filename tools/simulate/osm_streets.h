// Streets of an OpenStreetMap file to simulate a drive on.
#pragma once

#include <filesystem>
#include <vector>

#include "mapmatch/network_builder.h"
#include "msgs/local_frame.h"
#include "tools/simulate/streets.h"

namespace maploop::simulate {

// Centrelines with their corners rounded, points 2 m apart; junctions nearer to each other than a
// car's turn are one. Streets through tunnels, those
// not open to cars, service roads and tracks are left out.
Streets streets_of(const mapmatch::MapExtract& map, const LocalFrame& frame);

}  // namespace maploop::simulate
