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

  // Where a row does not fit, all phases and Dopplers that do not with least absolute values
  // (Schlossmacher, "An iterative technique for absolute deviations curve fitting", JASA 68, 1973)
  // become inactive, but for those that fit the others; then the one row that fits worst, and
  // again, at most 8 times. The state has moved by dx().
  //
  // A residual of phase or Doppler is judged in its own standard deviation, of which the state has
  // taken up a part (Baarda, "A testing procedure for use in geodetic networks", 1968): a row that
  // the state follows shows little of its error. One of code, whose variance is not its size, in
  // that size.
  //
  // Where so few phases fit that others would have fitted as well, they say where the vehicle is to
  // a metre, and none is known to be wrong.
  void apply(FilterState& state, std::vector<Row>& rows);

  // m and so on; valid until the next update.
  const Eigen::VectorXd& dx() const { return dx_; }

 private:
  void apply_once(FilterState& state, const std::vector<Row>& rows);
  void apply_anew(FilterState& state, const std::vector<Row>& rows);
  void reject_together(FilterState& state, std::vector<Row>& rows);
  void readmit(FilterState& state, std::vector<Row>& rows);
  void doubt_phases(FilterState& state, std::vector<Row>& rows);
  Row* worst(const FilterState& state, std::vector<Row>& rows) const;

  double outlier_sigmas_;
  FilterState before_;
  std::vector<double> looser_;  // of each row's variance
  Eigen::VectorXd dx_;
};

}  // namespace maploop::ppp
