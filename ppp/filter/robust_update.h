// Updates a state by the rows of an epoch, without those that do not fit.
#pragma once

#include <vector>

#include "ppp/filter/epoch_rows.h"
#include "ppp/filter/filter_state.h"

namespace maploop::ppp {

class RobustUpdate {
 public:
  explicit RobustUpdate(const PppParameters& parameters)
      : late_freedom_(parameters.late_code_freedom),
        max_rejections_(parameters.outlier_rejections),
        doubtful_variance_(parameters.doubtful_phase_sigma * parameters.doubtful_phase_sigma),
        ambiguity_sigma_(parameters.ambiguity_sigma),
        dx_(FilterState::capacity) {}

  // Codes that are too long lose weight by their residual, as if that half of their errors had
  // Student's t-distribution: signals that were reflected arrive late. Codes that are too short do
  // not.
  //
  // If a row does not fit, a solution by least absolute values is computed (Schlossmacher, "An
  // iterative technique for absolute deviations curve fitting", JASA 68, 1973), and all phases and
  // Dopplers that do not fit it become inactive. Those of them that fit the solution of the
  // remaining rows are re-admitted. After that, the row that fits worst becomes inactive, one at a
  // time and at most `outlier_rejections` times. The state has moved by dx().
  //
  // The residual of a phase or Doppler is judged by its own standard deviation, which is smaller
  // than that of the measurement because the state has absorbed part of the error (Baarda, "A
  // testing procedure for use in geodetic networks", 1968). The residual of a code is judged by the
  // size of its error (Row::sigma), from which its variance differs.
  //
  // With four or fewer fitting phases, any other four might fit equally well: every phase then gets
  // additional noise for this epoch (`doubtful_phase_sigma`), and the misfits are marked as
  // doubtful, so that their ambiguities are kept, with the variance of the misfit added. One whose
  // misfit exceeds `ambiguity_sigma` would then be known worse than a new one, and is not kept.
  void apply(FilterState& state, std::vector<Row>& rows);

  // Returns the correction in the units of the state; valid until the next update.
  const Eigen::VectorXd& dx() const { return dx_; }

 private:
  void apply_once(FilterState& state, const std::vector<Row>& rows);
  void reapply(FilterState& state, const std::vector<Row>& rows);
  void weigh_late_codes(FilterState& state, const std::vector<Row>& rows);
  void reject_together(FilterState& state, std::vector<Row>& rows);
  void readmit(FilterState& state, std::vector<Row>& rows);
  void distrust_phases(FilterState& state, std::vector<Row>& rows);
  Row* worst(const FilterState& state, std::vector<Row>& rows) const;

  double late_freedom_;
  int max_rejections_;
  double doubtful_variance_;  // m^2
  double ambiguity_sigma_;    // m
  FilterState before_;
  std::vector<double> variance_factors_;  // factor on each row's variance
  Eigen::VectorXd dx_;
};

}  // namespace maploop::ppp
