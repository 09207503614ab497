// Whether the errors that are added to a reference are of sizes that a filter may expect.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace maploop::sensors {

enum class ErrorModel : std::uint8_t {
  given,  // of the sizes that the parameters say, which are those that the filter is told
  drawn,  // of sizes that the seed draws, from ranges stated beside each sensor; no filter is told
};
constexpr std::array<std::string_view, 2> names_of(ErrorModel) {
  return {"given", "drawn"};
}

}  // namespace maploop::sensors
