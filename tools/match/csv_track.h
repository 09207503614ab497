// Reads tracks in CSV by the names of their columns.
#pragma once

#include <string_view>

#include "tools/match/track.h"

namespace maploop::match {

struct TrackOptions {
  double sigma = 5.0;      // m on each axis, for positions without an accuracy in the file
  double min_sigma = 0.3;  // m on each axis, lower limit of accuracies in the file
};

// A file has a header line and one line for each fix, separated by comma, semicolon or tab. Names
// (case does not matter):
//   time       t, time, timestamp, stamp, gps_tow, "gps time" (s, or date and time)
//   position   lat, latitude; lon, lng, longitude (degrees)
//   accuracy   sigma, accuracy, pos_accuracy (m on each axis); sigma_e and sigma_n; or the
//              covariance cov_ee, cov_en, cov_nn (m^2)
//   speed      speed, v, vf, forward_speed (m/s); speed_sigma, sigma_speed
//   azimuth    azimuth_deg, azimuth, heading, course (degrees from north, clockwise);
//              azimuth_sigma_deg, sigma_azimuth;
//              or yaw (rad from east, counter-clockwise: OXTS)
//   yaw rate   yaw_rate, wz (rad/s, positive when turning left); hdop
//   visual odometry   visual_speed (m/s), visual_azimuth_deg (from any direction; empty where it
//              restarted)
// Other columns are ignored. Empty cells are unknown. Throws std::runtime_error naming file and
// line.
Track parse_csv_track(std::string_view text, std::string_view name, const TrackOptions& options);

}  // namespace maploop::match
