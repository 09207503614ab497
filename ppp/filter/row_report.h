// Draws the conclusions from the rows of an epoch after the update.
#pragma once

#include <vector>

#include "ppp/filter/code_levels.h"
#include "ppp/filter/epoch_rows.h"

namespace maploop::ppp {

// Reports residuals and misfits, and notes the codes' levels. A phase that did not fit has slipped:
// its ambiguity restarts. `dx` is the correction of the state.
void report_rows(const std::vector<Row>& rows, const Eigen::VectorXd& dx,
                 const std::vector<Tracked>& tracked, FilterState& state, CodeLevels& levels,
                 std::vector<SatelliteReport>& reports);

// Returns whether the codes are far from the position, or more than half their number is left out.
// If fewer than four are near it, four cannot tell which of them are wrong, but five far ones can.
bool disagree(const std::vector<Row>& rows, const Eigen::VectorXd& dx,
              const std::vector<Tracked>& tracked, const PppParameters& parameters);

}  // namespace maploop::ppp
