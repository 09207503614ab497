// Reads recorded drives, the input of the matcher, from common file formats.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "mapmatch/vehicle_fix.h"
#include "msgs/local_frame.h"

namespace maploop::match {

using Track = std::vector<mapmatch::VehicleFix>;  // in order of increasing stamps

struct TrackOptions {
  double sigma = 5.0;              // m on each axis, for positions without an accuracy in the file
  double min_sigma = 0.3;          // m on each axis, lower limit of accuracies in the file
  std::optional<Geodetic> origin;  // of a TUM trajectory's local east-north-up frame
};

// Reads CSV, GPX track points, NMEA 0183 (RMC, GGA, GST), TUM poses or an LCM log; plain or .gz,
// distinguished by name and content. Throws std::runtime_error naming the file, the line if there
// is one, and what to do, also if the track has more than input_limits::fixes.
Track read_track(const std::filesystem::path& file, const TrackOptions& options);

// A file has a header line and one line for each fix, separated by comma, semicolon or tab. Names
// (case does not matter; csv_track.cpp lists all of them):
//   time       t, time, timestamp, stamp, gps_tow (s, or date and time)
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
Track parse_gpx_track(std::string_view text, std::string_view name, const TrackOptions& options);
// Skips sentences with a wrong checksum. Throws std::runtime_error if the file has no position.
Track parse_nmea_track(std::string_view text, std::string_view name, const TrackOptions& options);
Track parse_tum_track(std::string_view text, std::string_view name, const TrackOptions& options);

// Reads a log of `maploop replay --record` or lcm-logger: the fused states, ten a second, or the
// GNSS fixes if there are no states. Throws std::runtime_error if the log is damaged.
Track read_log_track(const std::filesystem::path& file);

// For the readers above: appends a fix read from the file `name`.
void keep(const mapmatch::VehicleFix& fix, std::string_view name, Track& track);

// For the readers above: parses seconds ("12.5", also since 1970), or a date and time
// ("2011-09-26 13:10:51.17", "2011-09-26T13:10:51Z"); returns nothing for other texts.
std::optional<Time> parse_track_time(std::string_view text);

}  // namespace maploop::match
