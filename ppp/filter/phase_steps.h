// Finds slips of single cycles on one carrier. From one epoch to the next, all phases change by the
// same displacement of the antenna and the same step of its clock, to within millimetres.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace maploop::ppp {

// A PhaseStep is the change of one satellite's phase since the previous epoch.
struct PhaseStep {
  std::size_t tracked = 0;                // index into the epoch's tracked satellites
  Eigen::Vector3d to_satellite{0, 0, 0};  // unit vector
  double change = 0.0;                    // m, in addition to the change of the predicted range
  double limit = 0.0;                     // m, the largest misfit without a slip
  bool slipped = false;
};

// Marks the steps that do not fit the displacement and clock step of the others, which are found by
// least absolute values (Schlossmacher, JASA 68, 1973). If fewer than five agree, none is marked,
// because another subset would have fitted equally well.
void find_slips(std::vector<PhaseStep>& steps);

}  // namespace maploop::ppp
