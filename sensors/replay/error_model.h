// This file states whether errors added to a reference have sizes that a filter may expect.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace maploop::sensors {

enum class ErrorModel : std::uint8_t {
  given,  // sizes as the parameters state, which the filter is given too
  drawn,  // sizes that the seed draws from ranges stated beside each sensor, unknown to filters
};
constexpr std::array<std::string_view, 2> names_of(ErrorModel) {
  return {"given", "drawn"};
}

}  // namespace maploop::sensors
