// A live stream of corrections for the ppp thread.
#pragma once

#include <memory>
#include <vector>

#include "msgs/sample.h"
#include "ppp/readers/navigation.h"
#include "ppp/readers/ssr.h"
#include "sensors/clock/host_clock.h"
#include "sensors/live/connection.h"
#include "sensors/live/live_source.h"

namespace maploop::vehicle {

// What has come at one time; `stamp` is its arrival.
struct GnssCorrections : Sample {
  ppp::BroadcastMessages heard;
  std::vector<ppp::SsrUpdate> updates;
};

// RTCM 3: ephemerides and SSR (ppp/readers/ssr.h). `clock` must outlive what is made.
std::unique_ptr<sensors::LiveSource<GnssCorrections>> listen_to_corrections(
    std::unique_ptr<sensors::ByteStream> caster, const sensors::HostClock& clock);

}  // namespace maploop::vehicle
