// Parameters of the map feedback; feedback_parameter_table.cpp describes each.
#pragma once

namespace maploop::mapmatch {

// Tells when the matched road is fed back, and how precise it is.
struct FeedbackParameters {
  static constexpr int max_window = 64;  // upper limit of `window`

  // The matched position and azimuth replace those of the filter, as in the thesis. [map] mode sets
  // it, so that it is no key of [feedback].
  bool hard_reset = false;

  // When a match is fed back.
  double min_speed = 3.0;           // m/s
  double max_azimuth_error = 0.26;  // rad (15 deg)
  double azimuth_sigmas = 3.0;      // the same in sigmas of the azimuth; the larger limit counts
  double max_lost_azimuth = 1.05;   // rad (60 deg)
  double max_turn = 0.087;          // rad (5 deg)
  double turn_interval = 2.0;       // s
  double lost_turn_interval = 0.5;  // s
  double junction_distance = 15.0;  // m
  double junction_sigmas = 2.0;     // the same in sigmas along the link; the larger counts
  double min_probability = 0.8;     // least probability of the link
  double min_margin = 0.6;          // least lead over the probability of the second link
  double parallel_azimuth = 0.44;   // rad (25 deg)
  double parallel_sigmas = 3.0;     // distance in sigmas up to which a parallel road is possible
  int window = 20;                  // feedbacks over which the squared innovation is averaged
  double max_mean_nis = 2.0;        // largest such mean; 1 is expected

  // What is fed back.
  double spacing = 10.0;          // m
  double azimuth_spacing = 25.0;  // m
  double cross_sigma = 1.0;       // m
  double map_sigma = 1.5;         // m
  double lane_share = 0.4;        // 0: centre line; 1: middle of its own lane
  double azimuth_sigma = 0.052;   // rad (3 deg)
  double bend_sigma = 0.105;      // rad (6 deg)
  double straight = 0.07;         // rad (4 deg)
  double chord = 8.0;             // m
  int ramp = 3;                   // feedbacks on a new link with larger sigmas
  double ramp_factor = 2.0;       // factor on the sigmas of these feedbacks
  double new_road_turn = 0.52;    // rad (30 deg)
};

}  // namespace maploop::mapmatch
