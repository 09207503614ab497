// The side of the road on which traffic keeps.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace maploop {

// by_map: the side that most opposite carriageways of the map show; right if there are none.
enum class RoadSide : std::uint8_t { by_map, right, left };
constexpr std::array<std::string_view, 3> names_of(RoadSide) {
  return {"by-map", "right", "left"};
}

}  // namespace maploop
