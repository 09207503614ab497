// A GnssEpoch is what a GNSS receiver measured at one moment, as a sample of the graph.
#pragma once

#include "msgs/sample.h"
#include "ppp/observations.h"
#include "ppp/readers/files/navigation.h"

namespace maploop::vehicle {

struct GnssEpoch : Sample {
  ppp::Epoch epoch;
  ppp::BroadcastMessages heard;  // since the epoch before, from a live receiver
};

}  // namespace maploop::vehicle
