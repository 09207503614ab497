// Positions from all epochs of a recording, also those that come later: the filter runs over it
// forward and backward, and both solutions of an epoch are combined (the two-filter smoother of
// Fraser and Potter, IEEE Transactions on Automatic Control 14, 1969).
#pragma once

#include <vector>

#include "ppp/filter/solution.h"
#include "ppp/observations.h"

namespace maploop::ppp {

// Returns the epochs in the opposite order. A loss of lock or of power, which a file states after
// it, is moved to the epoch before it, which now comes second.
std::vector<Epoch> reversed(const std::vector<Epoch>& epochs);

// Returns the combination of the solutions of one epoch by a filter that ran forward and one that
// ran backward. If one of them has no position, the other one is returned. Both contain this epoch,
// the models' errors and what is known before the first epoch, to an unknown degree. So the
// covariances are intersected ((29) of METHOD.md), which is right however much the two have in
// common. The satellites' reports are those of the more accurate one.
PppSolution combined(const PppSolution& forward, const PppSolution& backward);

}  // namespace maploop::ppp
