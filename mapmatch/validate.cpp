#include "mapmatch/validate.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>

#include "mapmatch/parameter_fields.h"

namespace maploop::mapmatch {

void validate(const MatchParameters& parameters) {
  // What is divided by, or a time or length without which nothing is remembered.
  constexpr std::array<std::string_view, 9> positive{
      "map_sigma", "road_noise", "azimuth_noise", "correlation_time", "gate",
      "prune",     "memory",     "distance_unit", "hdop_unit"};
  fields(parameters, [&](std::string_view name, double value) {
    bool must_be_more = false;
    for (const std::string_view p : positive) must_be_more = must_be_more || p == name;
    if (std::isfinite(value) && (must_be_more ? value > 0.0 : value >= 0.0)) return;
    throw std::invalid_argument("map matching: " + std::string(name) + " must be " +
                                (must_be_more ? "positive" : "0 or more") + ", not " +
                                std::to_string(value));
  });
}

}  // namespace maploop::mapmatch
