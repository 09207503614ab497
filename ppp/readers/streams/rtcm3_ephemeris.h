// Decodes broadcast ephemerides in RTCM 3: 1019 (GPS), 1020 (GLONASS), 1042 (BeiDou), 1044 (QZSS),
// 1045 and 1046 (Galileo, F/NAV and I/NAV).
#pragma once

#include "ppp/readers/files/navigation.h"
#include "ppp/readers/streams/rtcm3_frames.h"

namespace maploop::ppp {

// Adds the ephemeris of a message to `to`, or counts it there as refused if it cannot be right.
// Returns false if the message is of another type. `now` is as in broadcast_fields.h.
bool add_ephemeris(const Rtcm3Message& message, GpsTime now, NavigationFile& to);

}  // namespace maploop::ppp
