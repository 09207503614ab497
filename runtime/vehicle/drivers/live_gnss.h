// Receives live streams of GNSS: a receiver's own fixes, its observations, and corrections of them.
#pragma once

#include <memory>

#include "msgs/gnss.h"
#include "runtime/vehicle/drivers/gnss_epoch.h"
#include "sensors/clock/host_clock.h"
#include "sensors/live/connection.h"
#include "sensors/live/live_source.h"

namespace maploop::vehicle {

// The stamp of a fix or an epoch is its GPS time on the host's clock (ClockOffset), and it arrives
// at least `latency` after its time. `clock` must outlive the results.

// Reads the fixes of u-blox's binary protocol, UBX NAV-PVT, and skips other messages and text.
std::unique_ptr<sensors::LiveSource<GnssFix>> listen_to_fixes(
    std::unique_ptr<sensors::ByteStream> receiver, Duration latency,
    const sensors::HostClock& clock);

// Reads observations of UBX or RTCM 3.
std::unique_ptr<sensors::LiveSource<GnssEpoch>> listen_to_receiver(
    std::unique_ptr<sensors::ByteStream> receiver, Duration latency,
    const sensors::HostClock& clock);

// Reads RTCM 3: ephemerides and SSR (ppp/readers/corrections/ssr.h).
std::unique_ptr<sensors::LiveSource<GnssCorrections>> listen_to_corrections(
    std::unique_ptr<sensors::ByteStream> caster, const sensors::HostClock& clock);

}  // namespace maploop::vehicle
