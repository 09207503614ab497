// Tracks in CSV, by the names of their columns.
#pragma once

#include <string_view>

#include "tools/match/track.h"

namespace maploop::match {

struct TrackOptions {
  double sigma = 5.0;      // m an axis, of positions whose accuracy the file does not say
  double min_sigma = 0.3;  // m an axis, of positions that claim more
};

// A header line and a line a fix, separated by comma, semicolon or tab. Names (case does not
// matter):
//   time       t, time, timestamp, stamp, gps_tow, "gps time" (s, or date and time)
//   position   lat, latitude; lon, lng, longitude (degrees)
//   accuracy   sigma, accuracy, pos_accuracy (m an axis); sigma_e and sigma_n; or the covariance
//              cov_ee, cov_en, cov_nn (m^2)
//   speed      speed, v, vf, forward_speed (m/s); speed_sigma, sigma_speed
//   azimuth    azimuth_deg, azimuth, heading, course (degrees from north, clockwise);
//   azimuth_sigma_deg, sigma_azimuth;
//              or yaw (rad from east, counter-clockwise: OXTS)
//   yaw rate   yaw_rate, wz (rad/s, positive when turning left); hdop
//   visual odometry   visual_speed (m/s), visual_azimuth_deg (from any direction; empty where it
//              began anew)
// Other columns are passed over. Empty cells are unknown. Throws std::runtime_error naming file and
// line.
Track parse_csv_track(std::string_view text, std::string_view name, const TrackOptions& options);

}  // namespace maploop::match
