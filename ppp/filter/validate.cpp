#include "ppp/filter/validate.h"

#include <array>
#include <concepts>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "msgs/parameter_range.h"
#include "ppp/satellite.h"

namespace maploop::ppp {
namespace {

constexpr double long_time = 1e7;  // s
constexpr double any_sigma = 1e4;  // m
constexpr double any_gate = 1e9;   // more lets everything through
constexpr double smallest = 1e-6;  // of what is divided by

constexpr std::array ppp_ranges{ParameterRange{"elevation_mask", 0.0, 90.0, "degrees"},
                                ParameterRange{"cn0_mask", 0.0, 100.0, "dB-Hz"},
                                ParameterRange{"code_sigma", smallest, any_sigma, "m"},
                                ParameterRange{"phase_sigma", smallest, any_sigma, "m"},
                                ParameterRange{"doppler_sigma", smallest, any_sigma, "m/s"},
                                ParameterRange{"glonass_code_factor", smallest, 1000.0},
                                ParameterRange{"code_correlation", 0.0, long_time, "s"},
                                ParameterRange{"code_correlation_distance", smallest, 1e6, "m"},
                                ParameterRange{"glonass_code_correlation", 0.0, long_time, "s"},
                                ParameterRange{"code_level_time", 0.1, long_time, "s"},
                                ParameterRange{"reflection_time", 0.1, long_time, "s"},
                                ParameterRange{"reflection_distance", 0.1, 1e6, "m"},
                                ParameterRange{"full_cn0", 0.0, 100.0, "dB-Hz"},
                                ParameterRange{"full_cn0_drop", 0.0, 100.0, "dB"},
                                ParameterRange{"full_cn0_margin", 0.0, 100.0, "dB"},
                                ParameterRange{"zenith_wet_sigma", 0.0, 10.0, "m"},
                                ParameterRange{"zenith_wet_walk", 0.0, 1.0, "m/sqrt(s)"},
                                ParameterRange{"gradient_sigma", 0.0, 1.0, "m"},
                                ParameterRange{"gradient_walk", 0.0, 1.0, "m/sqrt(s)"},
                                ParameterRange{"horizontal_acceleration", 0.0, 1e4, "m^2/s^3"},
                                ParameterRange{"vertical_acceleration", 0.0, 1e4, "m^2/s^3"},
                                ParameterRange{"ambiguity_sigma", smallest, 1e6, "m"},
                                ParameterRange{"ambiguity_walk", 0.0, 1.0, "m/sqrt(s)"},
                                ParameterRange{"system_offset_walk", 0.0, 1000.0, "m/sqrt(s)"},
                                ParameterRange{"position_sigma", smallest, 1e6, "m"},
                                ParameterRange{"model_sigma", 0.0, 100.0, "m"},
                                ParameterRange{"outlier_sigmas", 0.1, any_gate},
                                ParameterRange{"code_gate", 0.1, any_gate, "m"},
                                ParameterRange{"longest_gap", 0.0, 1e6, "epochs"},
                                ParameterRange{"single_code_sigma", smallest, any_sigma, "m"},
                                ParameterRange{"single_phase_sigma", smallest, any_sigma, "m"},
                                ParameterRange{"map_useful_share", 0.0, 1000.0},
                                ParameterRange{"map_gate", 0.0, any_gate},
                                ParameterRange{"map_slip", smallest, 100.0, "m/s"},
                                ParameterRange{"map_reach", 0.0, 60.0, "s"},
                                ParameterRange{"map_datum_sigma", 0.0, 1000.0, "m"},
                                ParameterRange{"map_lasting_time", 0.1, long_time, "s"},
                                ParameterRange{"map_lasting_share", 0.0, 1.0},
                                ParameterRange{"map_lane_length", 0.1, 1e6, "m"},
                                ParameterRange{"map_lane_lasting", 0.0, 1.0},
                                ParameterRange{"map_difference_gate", 0.0, any_gate},
                                ParameterRange{"map_patience", 0.0, long_time, "s"},
                                ParameterRange{"map_most_gated", 1.0, 1e6, "lines"},
                                ParameterRange{"map_pause", 0.0, long_time, "s"}};

}  // namespace

void validate(const PppParameters& parameters) {
  for (const char letter : parameters.systems) {
    if (system_of(letter)) continue;
    throw std::invalid_argument("[ppp] systems is \"" + parameters.systems + "\"; '" +
                                std::string{letter} + "' is none of the letters G R E C J S I");
  }
  if (parameters.systems.empty()) {
    throw std::invalid_argument("[ppp] systems is empty; it must name one of G R E C J S I");
  }
  fields(parameters, []<class T>(std::string_view name, const T& value) {
    if constexpr (!std::same_as<T, bool> && !std::is_enum_v<T>) {
      check_range("ppp", ppp_ranges, name, value);
    }
  });
}

}  // namespace maploop::ppp
