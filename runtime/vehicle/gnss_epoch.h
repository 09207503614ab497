// What a GNSS receiver measured at one moment, as a sample of the graph.
#pragma once

#include "msgs/sample.h"
#include "ppp/observations.h"

namespace maploop::vehicle {

struct GnssEpoch : Sample {
  ppp::Epoch epoch;
};

}  // namespace maploop::vehicle
