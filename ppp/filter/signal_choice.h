// Chooses the satellites of an epoch that are used, and their signals.
#pragma once

#include <vector>

#include "ppp/filter/parameters.h"
#include "ppp/filter/range_model.h"
#include "ppp/filter/solution.h"

namespace maploop::ppp {

// Fills `measured` with the measurements that can be used, and `reports` with a report for each
// satellite of the systems in use.
void choose_signals(const Epoch& epoch, const RangeInputs& inputs, const PppParameters& parameters,
                    std::vector<Measurement>& measured, std::vector<SatelliteReport>& reports);

}  // namespace maploop::ppp
