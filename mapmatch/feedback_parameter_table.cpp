#include "mapmatch/parameter_table.h"

#include <numbers>

namespace maploop::mapmatch {

ParameterTable<FeedbackParameters> parameter_table(const FeedbackParameters&) {
  using enum Audience;
  using P = FeedbackParameters;
  constexpr double pi = std::numbers::pi;
  constexpr DataChoice lane_share_choice{"KITTI odometry sequences, 34 two-way roads",
                                         "mean offset of the truth from the line",
                                         "the map in the loop on KITTI; the road in PPP on KITTI's "
                                         "map. Not Riverside, nor simulated towns"};
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"min_speed", &P::min_speed, 0.0, 100.0, "m/s", expert,
       "Speed from which the road is used. At a lower speed the azimuth drifts unseen."},
      {"max_azimuth_error", &P::max_azimuth_error, 0.0, pi, "rad", expert,
       "Largest difference between the azimuths of vehicle and link."},
      {"azimuth_sigmas", &P::azimuth_sigmas, 0.0, 100.0, "1", expert,
       "The same in standard deviations of the vehicle's azimuth, where that is more."},
      {"max_lost_azimuth", &P::max_lost_azimuth, 0.0, pi, "rad", expert,
       "Upper limit of the difference in standard deviations."},
      {"max_turn", &P::max_turn, 0.0, pi, "rad", expert,
       "Largest difference between the turns of vehicle and link within turn_interval."},
      {"turn_interval", &P::turn_interval, 0.01, 60.0, "s", expert, "See max_turn."},
      {"lost_turn_interval", &P::lost_turn_interval, 0.01, 60.0, "s", expert,
       "The same while the azimuth is lost."},
      {"junction_distance", &P::junction_distance, 0.0, 10'000.0, "m", expert,
       "Least distance from a junction."},
      {"junction_sigmas", &P::junction_sigmas, 0.0, 100.0, "1", expert,
       "The same in standard deviations of the position along the link, where that is more."},
      {"min_probability", &P::min_probability, 0.0, 1.0, "1", expert,
       "Least probability of the link."},
      {"min_margin", &P::min_margin, 0.0, 1.0, "1", expert,
       "Least difference to the probability of the second link."},
      {"parallel_azimuth", &P::parallel_azimuth, 0.0, pi, "rad", expert,
       "Difference in azimuth up to which another road counts as parallel."},
      {"parallel_sigmas", &P::parallel_sigmas, 0.0, 100.0, "1", expert,
       "Distance in standard deviations up to which a parallel road is possible."},
      {"window", &P::window, 1, P::max_window, "feedbacks", expert,
       "Feedbacks over which the normalized innovation squared is averaged."},
      {"max_mean_nis", &P::max_mean_nis, above_zero, 1e6, "1", expert,
       "Largest accepted mean of the normalized innovation squared."},

      {"spacing", &P::spacing, 0.0, 10'000.0, "m", expert,
       "Way between two lines, so that the second tells something new."},
      {"azimuth_spacing", &P::azimuth_spacing, 0.0, 10'000.0, "m", expert,
       "Way between two azimuths."},
      {"cross_sigma", &P::cross_sigma, above_zero, 1000.0, "m", expert,
       "Standard deviation of the line that is independent from feedback to feedback."},
      {"map_sigma", &P::map_sigma, 0.0, 1000.0, "m", expert,
       "Standard deviation of the line that is constant along a road."},
      {"lane_share", &P::lane_share, 0.0, 1.0, "1", usual,
       "Place of a vehicle on average between the centre line of a two-way road (0) and the middle "
       "of its own lane (1), on the side of [map] side_of_road. 0: not known.",
       lane_share_choice},
      {"azimuth_sigma", &P::azimuth_sigma, above_zero, pi, "rad", expert,
       "Standard deviation of the azimuth of the vehicle in its lane."},
      {"bend_sigma", &P::bend_sigma, above_zero, pi, "rad", expert,
       "The same in a bend, where the azimuth is lost."},
      {"straight", &P::straight, 0.0, pi, "rad", expert,
       "A road that bends more gives no azimuth."},
      {"chord", &P::chord, 0.1, 1000.0, "m", expert,
       "Length of road before and behind the vehicle from which the line is taken."},
      {"ramp", &P::ramp, 0, 1'000'000, "feedbacks", expert,
       "Feedbacks on a new link that are given larger standard deviations."},
      {"ramp_factor", &P::ramp_factor, above_zero, 1000.0, "1", expert,
       "Factor on the standard deviations of those feedbacks."},
      {"new_road_turn", &P::new_road_turn, 0.0, pi, "rad", expert,
       "Turn of the vehicle after which it is on another road."},
  });
  return {"feedback", "When the matched road is fed back, and how precise it is.", table};
}

}  // namespace maploop::mapmatch
