// The update of a state by an epoch's rows, without those that do not fit.
#pragma once

#include <vector>

#include "ppp/filter/epoch_rows.h"
#include "ppp/filter/filter_state.h"

namespace maploop::ppp {

class RobustUpdate {
 public:
  explicit RobustUpdate(double outlier_sigmas)
      : outlier_sigmas_(outlier_sigmas), dx_(FilterState::capacity) {}

  // Row by row; then the row that fits worst becomes inactive and all is done again, at most 8
  // times. The state has moved by dx().
  void apply(FilterState& state, std::vector<Row>& rows);

  // m and so on; valid until the next update.
  const Eigen::VectorXd& dx() const { return dx_; }

 private:
  Row* worst(std::vector<Row>& rows) const;

  double outlier_sigmas_;
  FilterState before_;
  Eigen::VectorXd dx_;
};

}  // namespace maploop::ppp
