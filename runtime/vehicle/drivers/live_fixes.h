// Receives a live GNSS receiver's own fixes in u-blox's binary protocol.
#pragma once

#include <memory>

#include "msgs/gnss.h"
#include "sensors/clock/host_clock.h"
#include "sensors/live/connection.h"
#include "sensors/live/live_source.h"

namespace maploop::vehicle {

// Reads UBX NAV-PVT and skips other messages and text. The stamp of a fix is its GPS time on the
// host's clock (ClockOffset), and a fix arrives at least `latency` after its time. `clock` must
// outlive the result.
std::unique_ptr<sensors::LiveSource<GnssFix>> listen_to_fixes(
    std::unique_ptr<sensors::ByteStream> receiver, Duration latency,
    const sensors::HostClock& clock);

}  // namespace maploop::vehicle
