// Another solution of the same epochs, to be subtracted.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "ppp/filter/solution.h"

namespace maploop::gnss {

struct OtherSolution {
  std::string name;
  std::map<ppp::GpsTime, Eigen::Vector3d> positions{};  // m, earth-fixed

  void add(const ppp::PppSolution& solution);
  // At this time, to 10 ms.
  std::optional<Eigen::Vector3d> at(ppp::GpsTime t) const;
};

// Reads RTKLIB's .pos, in XYZ or latitude, longitude, height. Throws std::runtime_error naming file
// and line.
OtherSolution read_solution(const std::filesystem::path& file);

}  // namespace maploop::gnss
