// Where the antenna's marker was, known by other means.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "ppp/gps_time.h"

namespace maploop::gnss {

class Truth {
 public:
  // For a place that does not move "X,Y,Z" in metres, or "latitude,longitude,height" in degrees and
  // metres, told apart by the distance from the earth's centre. Or a file: RTKLIB's .pos (its
  // fixed positions; all if none is, which is said on standard error), or rows "index, GPS seconds
  // of the week, X, Y, Z, ..." of the week of `near`; .gz too. Throws std::runtime_error.
  Truth(const std::string& text, ppp::GpsTime near);

  // At an epoch of the truth (to 10 ms), or between two that are at most 1.1 s apart.
  std::optional<Eigen::Vector3d> at(ppp::GpsTime t) const;

 private:
  void read_positions(const std::string& file);
  void read_rows(const std::string& file, ppp::GpsTime near);

  std::optional<Eigen::Vector3d> fixed_;
  std::map<ppp::GpsTime, Eigen::Vector3d> points_;
};

}  // namespace maploop::gnss
