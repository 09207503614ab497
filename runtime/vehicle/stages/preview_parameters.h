// [preview]: pictures and scans for dashboards.
#pragma once

namespace maploop::vehicle {

struct PreviewParameters {
  double rate = 2.0;  // Hz
  int width = 640;    // px
  int quality = 60;
  int points = 4000;
};

}  // namespace maploop::vehicle
