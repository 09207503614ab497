// What the health thread reports once a second.
#pragma once

#include "msgs/diagnostics.h"
#include "msgs/sample.h"

namespace maploop::vehicle {

struct RuntimeReport : Sample {
  Health health;
  Deadlines deadlines;
};

}  // namespace maploop::vehicle
