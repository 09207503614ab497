// Broadcast ephemerides in RTCM 3: 1019 (GPS), 1020 (GLONASS), 1042 (BeiDou), 1044 (QZSS), 1045 and
// 1046 (Galileo, F/NAV and I/NAV).
#pragma once

#include "ppp/readers/navigation.h"
#include "ppp/readers/rtcm3_frames.h"

namespace maploop::ppp {

// Adds what a message says to `to`; false where it is none of these. One that cannot be is refused
// there. `now` as in broadcast_fields.h.
bool add_ephemeris(const Rtcm3Message& message, GpsTime now, NavigationFile& to);

}  // namespace maploop::ppp
