// A live GNSS receiver's observations.
#pragma once

#include <memory>

#include "runtime/vehicle/gnss_epoch.h"
#include "sensors/clock/host_clock.h"
#include "sensors/live/connection.h"
#include "sensors/live/live_source.h"

namespace maploop::vehicle {

// UBX or RTCM 3. An epoch is stamped by its GPS time on the host's clock
// (ClockOffset); it is sent `latency` after its time, at least. `clock` must outlive what is made.
std::unique_ptr<sensors::LiveSource<GnssEpoch>> listen_to_receiver(
    std::unique_ptr<sensors::ByteStream> receiver, Duration latency,
    const sensors::HostClock& clock);

}  // namespace maploop::vehicle
