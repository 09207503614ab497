#include "ppp/filter/parameter_table.h"

namespace maploop::ppp {

ParameterTable<GroundParameters> parameter_table(const GroundParameters&) {
  using enum Audience;
  using P = GroundParameters;
  constexpr double any_sigma = 1e4;  // m
  constexpr double smallest = 1e-6;  // of what is divided by
  constexpr DataChoice choice{"simulated canyons, seeds 1 to 6",
                              "among a handful of sets by the errors, less than what fits these "
                              "densely built towns best",
                              "PPP between houses with heights, seeds 1 to 6"};
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"antenna_height", &P::antenna_height, -10.0, 100.0, "m", usual,
       "Height of the antenna above the road."},
      {"surface", &P::surface, -100.0, 100.0, "m", expert,
       "How much higher than the road the model is on average: radar sees roofs and trees. 0 for a "
       "model of the ground itself.",
       choice},
      {"datum_sigma", &P::datum_sigma, smallest, any_sigma, "m", expert,
       "Standard deviation of what the model is too high or too low by everywhere near: its long "
       "waves (SRTM: 1.6 m), the geoid, and how densely the place is built up.",
       choice},
      {"no_geoid_sigma", &P::no_geoid_sigma, smallest, any_sigma, "m", expert,
       "The same where there is no grid of the geoid."},
      {"error_sigma", &P::error_sigma, smallest, any_sigma, "m", expert,
       "Standard deviation of the model's error that changes along the way.", choice},
      {"error_length", &P::error_length, smallest, 1e6, "m", expert,
       "Way over which that error is correlated.", choice},
      {"noise", &P::noise, smallest, any_sigma, "m", expert,
       "Standard deviation of what is new at each epoch."},
      {"slope_sigma", &P::slope_sigma, 0.0, 10.0, "m/m", expert,
       "Standard deviation of the model's slope, which counts as far as the horizontal position is "
       "uncertain."},
      {"gate", &P::gate, smallest, 1e9, "1", expert,
       "Squared innovation, relative to its variance, above which a height is not used: the road "
       "may be a bridge or in a tunnel."},
  });
  return {"ppp.ground", "The height of the ground ([ppp] heights) in precise point positioning.",
          table};
}

}  // namespace maploop::ppp
