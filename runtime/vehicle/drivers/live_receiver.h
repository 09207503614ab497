// Receives a live GNSS receiver's observations.
#pragma once

#include <memory>

#include "runtime/vehicle/drivers/gnss_epoch.h"
#include "sensors/clock/host_clock.h"
#include "sensors/live/connection.h"
#include "sensors/live/live_source.h"

namespace maploop::vehicle {

// Reads UBX or RTCM 3. The stamp of an epoch is its GPS time on the host's clock (ClockOffset), and
// an epoch arrives at least `latency` after its time. `clock` must outlive the result.
std::unique_ptr<sensors::LiveSource<GnssEpoch>> listen_to_receiver(
    std::unique_ptr<sensors::ByteStream> receiver, Duration latency,
    const sensors::HostClock& clock);

}  // namespace maploop::vehicle
