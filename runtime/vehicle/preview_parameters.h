// [preview]: pictures and scans for dashboards.
#pragma once

#include <stdexcept>

namespace maploop::vehicle {

struct PreviewParameters {
  double rate = 2.0;  // Hz of the machine's clock; 0: none
  int width = 640;    // px of the picture, at most
  int quality = 60;   // of its JPEG
  int points = 4000;  // of a scan, at most
};

// Throws std::invalid_argument naming the key that is out of its range.
inline void check(const PreviewParameters& p) {
  if (!(p.rate >= 0.0 && p.rate <= 5.0))
    throw std::invalid_argument("[preview] rate must be 0 to 5 Hz");
  if (!(p.width >= 64 && p.width <= 1280))
    throw std::invalid_argument("[preview] width must be 64 to 1280 px");
  if (!(p.quality >= 1 && p.quality <= 100))
    throw std::invalid_argument("[preview] quality must be 1 to 100");
  if (!(p.points >= 0 && p.points <= 20000))
    throw std::invalid_argument("[preview] points must be 0 to 20000");
}

}  // namespace maploop::vehicle
