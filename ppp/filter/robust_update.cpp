#include "ppp/filter/robust_update.h"

#include <cmath>
#include <span>

namespace maploop::ppp {

Row* RobustUpdate::worst(std::vector<Row>& rows) const {
  Row* worst = nullptr;
  double largest = outlier_sigmas_;
  for (Row& row : rows) {
    if (!row.active) continue;
    const double normalized = std::abs(row.left(dx_)) / row.sigma;
    if (normalized > largest) {
      largest = normalized;
      worst = &row;
    }
  }
  return worst;
}

void RobustUpdate::apply(FilterState& state, std::vector<Row>& rows) {
  constexpr int most_rejections = 8;
  before_ = state;
  for (int pass = 0;; ++pass) {
    dx_.setZero();
    for (const Row& row : rows) {
      if (!row.active) continue;
      const auto n = static_cast<std::size_t>(row.count);
      state.update(std::span(row.indices).first(n), std::span(row.h).first(n), row.y, row.variance,
                   dx_);
    }
    Row* const misfit = worst(rows);
    if (misfit == nullptr || pass == most_rejections) break;
    misfit->active = false;
    state = before_;
  }
  state.x() += dx_.head(state.size());
}

}  // namespace maploop::ppp
