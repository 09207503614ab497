#include "ppp/filter/row_report.h"

#include <algorithm>

namespace maploop::ppp {

void report_rows(const std::vector<Row>& rows, const Eigen::VectorXd& dx,
                 const std::vector<Tracked>& tracked, FilterState& state, CodeLevels& levels,
                 std::vector<SatelliteReport>& reports) {
  for (const Row& row : rows) {
    const Tracked& t = tracked[row.tracked];
    SatelliteReport& report = reports[t.measurement.report];
    const double residual = row.residual_after(dx);
    const bool range = row.combination == Combination::range;
    switch (row.kind) {
      case RowKind::code:
        if (!range) break;
        report.code_residual = residual;
        levels.add(t.measurement.satellite,
                   residual * residual / (row.sigma * row.sigma) * t.level);
        report.code_used = row.active;
        if (!row.active) report.refused = PppRefusal::code_misfit;
        break;
      case RowKind::phase:
        if (range) {
          report.phase_residual = residual;
          report.phase_used = row.active;
        }
        if (row.active) break;
        report.refused = PppRefusal::phase_misfit;
        if (!row.doubtful) state.remove_ambiguities(t.measurement.satellite);
        break;
      case RowKind::doppler:
        if (!row.active) report.refused = PppRefusal::doppler_misfit;
        break;
    }
  }
}

bool disagree(const std::vector<Row>& rows, const Eigen::VectorXd& dx,
              const std::vector<Tracked>& tracked, const PppParameters& parameters) {
  int codes = 0, left_out = 0;
  double sum = 0.0;
  for (const Row& row : rows) {
    if (row.kind == RowKind::doppler || row.combination != Combination::range) continue;
    left_out += !row.active;
    if (row.kind != RowKind::code) continue;
    const double residual = row.residual_after(dx);
    sum += residual * residual / (row.sigma * row.sigma);
    ++codes;
  }
  const auto far = static_cast<int>(
      std::ranges::count_if(tracked, [](const Tracked& t) { return !t.code_good; }));
  if (codes < position_unknowns) return far > position_unknowns;
  return sum > parameters.restart_variance * codes || 2 * (left_out + far) > codes;
}

}  // namespace maploop::ppp
