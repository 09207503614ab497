// Writes observations as RINEX 3.04.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "ppp/gps_time.h"
#include "tools/simulate/gnss/receiver.h"

namespace maploop::simulate {

inline constexpr const char* antenna_type = "SIMULATED ROOF  NONE";

class ObservationText {
 public:
  // `carriers` is 2, or 1 for the first carriers only. `near` is an approximate position, m, ITRF;
  // `interval` is in s.
  ObservationText(std::size_t carriers, const Eigen::Vector3d& near, ppp::GpsTime first,
                  double interval);

  void add(ppp::GpsTime t, const std::vector<ObservedSatellite>& satellites);
  const std::string& text() const { return text_; }

 private:
  std::size_t carriers_;
  std::string text_;
};

}  // namespace maploop::simulate
