#include "ppp/observations.h"

namespace maploop::ppp {

void Epoch::clear() {
  time = {};
  power_failure = false;
  clock_offset = 0.0;
  satellites.clear();
  signals.clear();
}

}  // namespace maploop::ppp
