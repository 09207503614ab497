// Reads the streets to simulate a drive on from an OpenStreetMap file.
#pragma once

#include <filesystem>
#include <vector>

#include "mapmatch/network_builder.h"
#include "msgs/local_frame.h"
#include "tools/simulate/town/streets.h"

namespace maploop::simulate {

// Centrelines have rounded corners and points 2 m apart; junctions closer to each other than a
// car's turn become one. Streets through tunnels, streets not open to cars, service roads and
// tracks are left out.
Streets streets_of(const mapmatch::MapExtract& map, const LocalFrame& frame);

}  // namespace maploop::simulate
