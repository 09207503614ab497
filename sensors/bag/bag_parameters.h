// This file defines what can be set about bags and MCAP files: [bag] of the configuration.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/parameter.h"

namespace maploop::sensors {

enum class BagStamps : std::uint8_t { automatic, header, received };
constexpr std::array<std::string_view, 3> names_of(BagStamps) {
  return {"auto", "header", "received"};
}

enum class CloudStamp : std::uint8_t { start, middle, end };
constexpr std::array<std::string_view, 3> names_of(CloudStamp) {
  return {"start", "middle", "end"};
}

struct BagParameters {
  std::vector<std::string> topics;  // SENSOR=TOPIC, see topic_choice.h
  BagStamps stamps = BagStamps::automatic;
  // This is what the stamp of a cloud says of its turn, if its points have no times of their own.
  CloudStamp cloud_stamp = CloudStamp::middle;
  // These hold where the recording does not state them.
  double gnss_position_sigma = 3.0;  // m, of a fix without a covariance
  double gnss_velocity_sigma = 0.3;  // m/s, of the velocity
  double wheel_sigma = 0.1;          // m/s
};

ParameterTable<BagParameters> parameter_table(const BagParameters&);

}  // namespace maploop::sensors
