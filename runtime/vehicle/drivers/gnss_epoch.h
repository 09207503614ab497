// Defines what the drivers of GNSS send to the ppp thread.
#pragma once

#include <vector>

#include "msgs/sample.h"
#include "ppp/observations.h"
#include "ppp/readers/corrections/ssr.h"
#include "ppp/readers/files/navigation.h"

namespace maploop::vehicle {

// The measurements of a receiver at one moment.
struct GnssEpoch : Sample {
  ppp::Epoch epoch;
  ppp::BroadcastMessages heard;  // since the epoch before, from a live receiver
};

// The contents of a stream of corrections that arrived together, at `stamp`.
struct GnssCorrections : Sample {
  ppp::BroadcastMessages heard;
  std::vector<ppp::SsrUpdate> updates;
  std::optional<ppp::SsrIonosphere> ionosphere;
};

}  // namespace maploop::vehicle
