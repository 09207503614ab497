#include "estimators/fusion/parameter_table.h"

namespace maploop::fusion {

ParameterTable<ProtectionParameters> parameter_table(const ProtectionParameters&) {
  using enum Audience;
  using P = ProtectionParameters;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"integrity_risk", &P::integrity_risk, 1e-12, 0.5, "1", usual,
       "Probability of an error beyond its protection level, at one moment."},
      {"overconfidence", &P::overconfidence, above_zero, 1000.0, "1", expert,
       "Ratio of the squared errors of a position to its covariance, as in [guard]."},
      {"model_sigma", &P::model_sigma, 0.0, 1000.0, "m", expert,
       "Error of a position that its covariance does not contain, standard deviation on each "
       "axis."},
      {"model_share", &P::model_share, 0.0, 1.0, "1", expert,
       "The same as a share of the way without a fix."},
      {"window", &P::window, 1.0, 600.0, "s", expert,
       "Time before which fixes are taken to be right, for the position without them."},
      {"fix_memory", &P::fix_memory, 0.1, 600.0, "s", expert,
       "Time for which a fix counts in the position without odometry, which is their median."},
      {"map_fault", &P::map_fault, 0.0, 1.0, "1", expert,
       "Probability that the filter believes a wrong road, at one moment."},
      {"gnss_fault", &P::gnss_fault, 0.0, 1.0, "1", expert,
       "Probability that fixes are wrong by more than they say and the filter has not noticed."},
      {"odometry_fault", &P::odometry_fault, 0.0, 1.0, "1", expert,
       "The same of the motions of odometry or of the wheels."},
  });
  return {"protection", "The protection levels of the fused position, on NAV_PROTECTION.", table};
}

}  // namespace maploop::fusion
