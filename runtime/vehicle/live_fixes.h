// A live GNSS receiver's own fixes, in u-blox's binary protocol.
#pragma once

#include <memory>

#include "msgs/gnss.h"
#include "sensors/clock/host_clock.h"
#include "sensors/live/connection.h"
#include "sensors/live/live_source.h"

namespace maploop::vehicle {

// UBX NAV-PVT; other messages and text are passed over. A fix is stamped by its GPS time on the
// host's clock (ClockOffset); it is sent `latency` after its time, at least. `clock` must outlive
// what is made.
std::unique_ptr<sensors::LiveSource<GnssFix>> listen_to_fixes(
    std::unique_ptr<sensors::ByteStream> receiver, Duration latency,
    const sensors::HostClock& clock);

}  // namespace maploop::vehicle
