// Slips of single cycles on one carrier: from one epoch to the next all phases change by one
// displacement of the antenna and one step of its clock, to millimetres.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace maploop::ppp {

// Of one satellite, since the epoch before.
struct PhaseStep {
  std::size_t tracked = 0;                // whose
  Eigen::Vector3d to_satellite{0, 0, 0};  // unit vector
  double change = 0.0;                    // m, beyond that of the predicted range
  double limit = 0.0;                     // m, that it may differ by without a slip
  bool slipped = false;
};

// Finds those that differ from the displacement and step of the others, which are found by least
// absolute values (Schlossmacher, JASA 68, 1973). None is said to have slipped where fewer than
// five agree: then others would have fitted as well.
void find_slips(std::vector<PhaseStep>& steps);

}  // namespace maploop::ppp
