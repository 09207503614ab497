// What a GNSS receiver says at one moment, as a sample of the graph.
#pragma once

#include "msgs/sample.h"
#include "ppp/observations.h"
#include "ppp/readers/navigation.h"

namespace maploop::vehicle {

struct GnssEpoch : Sample {
  ppp::Epoch epoch;
  ppp::BroadcastMessages heard;  // of a live receiver: since the epoch before
};

}  // namespace maploop::vehicle
