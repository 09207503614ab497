// Maps the signals of RTCM 3's MSM to their RINEX 3 names.
#pragma once

#include <optional>
#include <string_view>

#include "ppp/satellite.h"

namespace maploop::ppp {

// Returns the name, such as "1C", of bit `place` (from 1) of a system's signal mask, as in RTCM
// 10403.3, tables 3.5-91 to 3.5-108; empty if the bit has no signal.
std::string_view msm_signal(System system, int place);

// Returns the satellite of bit `place` (from 1) of the satellite mask.
std::optional<Satellite> msm_satellite(System system, int place);

}  // namespace maploop::ppp
