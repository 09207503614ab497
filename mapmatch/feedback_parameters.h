// Parameters of the map feedback.
#pragma once

namespace maploop::mapmatch {

struct FeedbackParameters {
  bool hard_reset = false;  // the matched place and azimuth replace the filter's, as in the thesis

  // When the road is believed.
  double min_speed = 3.0;           // m/s, slower an azimuth drifts unseen
  double max_azimuth_error = 0.26;  // rad (15 deg), against the link
  double azimuth_sigmas = 3.0;      // 1, or so many of the azimuth's own, ...
  double max_lost_azimuth = 1.05;   // rad (60 deg), ... up to this
  double max_turn = 0.087;          // rad (5 deg), turning against the link's own, within ...
  double turn_interval = 2.0;       // s, ... this time
  double lost_turn_interval = 0.5;  // s, the same while the azimuth is lost
  double junction_distance = 15.0;  // m, at least, and ...
  double junction_sigmas = 2.0;     // 1, ... so many of the position along the link
  double min_probability = 0.8;     // P(link)
  double min_margin = 0.6;          // of P(link) to the second
  double parallel_azimuth = 0.44;   // rad (25 deg), another road within this is parallel ...
  double parallel_sigmas = 3.0;     // 1, ... and possible when it is as near as this
  int window = 20;                  // feedbacks whose ...
  double max_mean_nis = 2.0;        // 1, ... offsets squared, in sigmas, are this at most

  // What the road says.
  double spacing = 10.0;          // m between two lines that say something new
  double azimuth_spacing = 25.0;  // m, and between two azimuths
  double cross_sigma = 1.0;       // m, of the line, new at each
  double map_sigma = 1.5;         // m, of the line, along the whole of a road
  // Of the way from a line for both directions to the middle of a lane, to the right: on 34 ways of
  // KITTI's drives 0.4 on average. Negative where traffic keeps left; 0: not known.
  double lane_share = 0.4;
  double azimuth_sigma = 0.052;  // rad (3 deg), of the vehicle in its lane
  double bend_sigma = 0.105;     // rad (6 deg), the same in a bend, where the azimuth is lost
  double straight = 0.07;        // rad (4 deg), a road that bends more has no azimuth
  double chord = 8.0;            // m before and behind, that a line is taken from
  int ramp = 3;                  // feedbacks on a new link with ...
  double ramp_factor = 2.0;      // 1, ... sigmas so much larger
  double new_road_turn = 0.52;   // rad (30 deg), turned more, it is another road
};

}  // namespace maploop::mapmatch
