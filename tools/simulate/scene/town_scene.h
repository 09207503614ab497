// Builds the scene of the town: ground, buildings, hedges, fences, poles, trees, parked cars.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "tools/simulate/scene/mesh.h"
#include "tools/simulate/town/streets.h"
#include "tools/simulate/town/terrain.h"

namespace maploop::simulate {

enum class Environment : std::uint8_t {
  town,      // houses of two to five storeys, with gaps
  open,      // no houses, few trees
  suburban,  // low houses in gardens
  urban,     // six to ten storeys without gaps
};
constexpr std::array<std::string_view, 4> names_of(Environment) {
  return {"town", "open", "suburban", "urban"};
}

// Lines every street. Buildings, hedges and fences stand behind the pavement and do not overlap;
// poles, some trees and parked cars stand on it.
Mesh make_town_scene(const Streets& streets, const StreetIndex& index, const Terrain& terrain,
                     std::uint64_t seed, Environment environment = Environment::town);

}  // namespace maploop::simulate
