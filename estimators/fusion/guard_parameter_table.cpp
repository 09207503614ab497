#include "estimators/fusion/parameter_table.h"

#include "estimators/fusion/data_choices.h"

namespace maploop::fusion {

ParameterTable<GuardParameters> parameter_table(const GuardParameters&) {
  using enum Audience;
  using P = GuardParameters;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"lifetime", &P::lifetime, 0.1, 3600.0, "s", expert,
       "Lifetime of a copy of the filter that takes no feedback. There are two copies, half of "
       "that apart."},
      {"difference_gate", &P::difference_gate, 0.0, 1e6, "1", expert,
       "Distance of the filter from a copy beyond which it may have been led astray (chi-square, 2 "
       "degrees of freedom); the default has a tail of 0.1 %."},
      {"patience", &P::patience, 0.0, 3600.0, "s", expert,
       "Time for which the filter is that far from a copy until the road is taken to be wrong and "
       "the copy takes the filter's place."},
      {"trusted", &P::trusted, 0.0, 1e6, "1", expert,
       "Distance from the older copy up to which a new copy is made of the filter (chi-square, 2 "
       "degrees of freedom); the default has a tail of 10 %."},
      {"pause", &P::pause, 0.0, 3600.0, "s", expert,
       "Time without feedback after the copy has taken the filter's place."},
      {"lost_azimuth", &P::lost_azimuth, above_zero, 3.2, "rad", expert,
       "Standard deviation of an azimuth from which it counts as lost."},
      {"overconfidence", &P::overconfidence, above_zero, 1000.0, "1", expert,
       "Ratio of the squared errors of dead reckoning to its covariance. Drives of 60 s without "
       "GNSS have a mean NEES of 2.9 to 4 where 2 is expected.",
       overconfidence_choice},
      {"model_sigma", &P::model_sigma, 0.0, 1000.0, "m", expert,
       "Difference between filter and copy that is allowed beyond their covariances, because the "
       "model of the copy errs, too."},
      {"model_share", &P::model_share, 0.0, 1.0, "1", expert,
       "The same as a share of the way since the copy was made."},
  });
  return {"guard", "The guard against wrong roads: copies of the filter that take no feedback.",
          table};
}

}  // namespace maploop::fusion
