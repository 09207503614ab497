#include "ppp/filter/robust_update.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "ppp/filter/row_update.h"

namespace maploop::ppp {
namespace {

constexpr int absolute_passes = 5;  // until sums of absolute values settle
// A new ambiguity absorbs its whole phase: below this share of the variance nothing is to be
// tested.
constexpr double least_share = 1e-3;

}  // namespace

Row* RobustUpdate::worst(const FilterState& state, std::vector<Row>& rows) const {
  Row* worst = nullptr;
  double largest = 1.0;  // of what a row may have
  for (Row& row : rows) {
    if (!row.active) continue;
    double sigma = row.sigma;  // (15) of METHOD.md
    if (row.kind != RowKind::code) {
      const double share = 1.0 - predicted_variance(state, row) / row.variance;
      if (share < least_share) continue;
      sigma *= std::sqrt(share);  // (16) of METHOD.md
    }
    const double normalized = std::abs(row.residual_after(dx_)) / (sigma * row.most_sigmas);
    if (normalized > largest) {
      largest = normalized;
      worst = &row;
    }
  }
  return worst;
}

void RobustUpdate::apply_once(FilterState& state, const std::vector<Row>& rows) {
  dx_.setZero();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    if (!row.active) continue;
    const auto n = static_cast<std::size_t>(row.count);
    state.update(std::span(row.indices).first(n), std::span(row.h).first(n), row.y,
                 row.variance * variance_factors_[i], dx_);
  }
}

void RobustUpdate::reapply(FilterState& state, const std::vector<Row>& rows) {
  state = before_;
  apply_once(state, rows);
}

void RobustUpdate::weigh_late_codes(FilterState& state, const std::vector<Row>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    if (row.kind != RowKind::code || row.combination != Combination::range) continue;
    const double late = std::max(0.0, row.residual_after(dx_) / row.sigma);
    variance_factors_[i] = 1.0 + late * late / late_freedom_;
  }
  reapply(state, rows);
}

// Several outliers can move the state so far that good rows fit worse than the outliers do.
// Weighting by the residuals minimizes the sum of absolute values instead, which outliers move
// less.
void RobustUpdate::reject_together(FilterState& state, std::vector<Row>& rows) {
  const auto misfit = [this](const Row& row) {
    return std::abs(row.residual_after(dx_)) / row.sigma;
  };
  for (int pass = 0; pass < absolute_passes; ++pass) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i].kind != RowKind::code) variance_factors_[i] = std::max(1.0, misfit(rows[i]));
    }
    reapply(state, rows);
  }
  for (Row& row : rows) row.active = row.kind == RowKind::code || misfit(row) <= row.most_sigmas;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].kind != RowKind::code) variance_factors_[i] = 1.0;
  }
  reapply(state, rows);
  readmit(state, rows);
}

// Re-admits rejected rows that agree with the state estimated without them.
void RobustUpdate::readmit(FilterState& state, std::vector<Row>& rows) {
  bool again = false;
  for (Row& row : rows) {
    if (row.active) continue;
    const double variance = row.sigma * row.sigma + predicted_variance(state, row);
    row.active = std::abs(row.residual_after(dx_)) <= row.most_sigmas * std::sqrt(variance);
    again |= row.active;
  }
  if (!again) return;
  reapply(state, rows);
}

// If no more phases fit than there are unknowns (position and clock), any other choice of as many
// would fit equally well: it is unknown which of them have slipped. Those that do not fit keep
// their ambiguities, but are no longer certain of them: otherwise two that slipped would move the
// position once those that fit have lost lock.
void RobustUpdate::distrust_phases(FilterState& state, std::vector<Row>& rows) {
  int fit = 0, left_out = 0;
  for (const Row& row : rows) {
    if (row.kind == RowKind::phase && !row.new_ambiguity && row.combination == Combination::range)
      ++(row.active ? fit : left_out);
  }
  if (left_out == 0 || fit > position_unknowns) return;
  for (Row& row : rows) {
    if (row.kind != RowKind::phase || row.new_ambiguity) continue;
    row.doubtful = !row.active;
    row.variance += doubtful_variance_;
  }
  reapply(state, rows);
  for (Row& row : rows) {
    if (!row.doubtful) continue;
    const int ambiguity = row.indices[static_cast<std::size_t>(row.count) - 1];
    const double misfit = row.residual_after(dx_);
    row.doubtful = std::abs(misfit) <= ambiguity_sigma_;
    if (!row.doubtful) continue;
    state.P()(ambiguity, ambiguity) += misfit * misfit;
  }
}

void RobustUpdate::apply(FilterState& state, std::vector<Row>& rows) {
  before_ = state;
  variance_factors_.reserve(rows.capacity());
  variance_factors_.assign(rows.size(), 1.0);
  apply_once(state, rows);
  weigh_late_codes(state, rows);
  if (worst(state, rows) != nullptr) {
    reject_together(state, rows);
    weigh_late_codes(state, rows);
  }
  for (int pass = 0;; ++pass) {
    Row* const misfit = worst(state, rows);
    if (misfit == nullptr || pass == max_rejections_) break;
    misfit->active = false;
    reapply(state, rows);
  }
  distrust_phases(state, rows);
  state.x() += dx_.head(state.size());
}

}  // namespace maploop::ppp
