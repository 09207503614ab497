// Receives corrections for the ppp thread as a live stream.
#pragma once

#include <memory>
#include <vector>

#include "msgs/sample.h"
#include "ppp/readers/corrections/ssr.h"
#include "ppp/readers/files/navigation.h"
#include "sensors/clock/host_clock.h"
#include "sensors/live/connection.h"
#include "sensors/live/live_source.h"

namespace maploop::vehicle {

// GnssCorrections is what arrived at one time, which is `stamp`.
struct GnssCorrections : Sample {
  ppp::BroadcastMessages heard;
  std::vector<ppp::SsrUpdate> updates;
};

// `caster` sends RTCM 3: ephemerides and SSR (ppp/readers/corrections/ssr.h). `clock` must outlive
// the result.
std::unique_ptr<sensors::LiveSource<GnssCorrections>> listen_to_corrections(
    std::unique_ptr<sensors::ByteStream> caster, const sensors::HostClock& clock);

}  // namespace maploop::vehicle
