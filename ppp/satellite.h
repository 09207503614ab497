// Satellites and their carriers.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "msgs/archive.h"

namespace maploop::ppp {

inline constexpr double speed_of_light = 299792458.0;  // m/s

enum class System : std::uint8_t { gps, glonass, galileo, beidou, qzss, sbas, navic };
inline constexpr int system_count = 7;

// RINEX's letters: G R E C J S I.
char letter(System system);
std::optional<System> system_of(char letter);

struct Satellite {
  System system = System::gps;
  std::uint8_t number = 0;  // as RINEX 3 writes it, 1 to 99

  auto operator<=>(const Satellite&) const = default;
  // Unique and below satellite_slots: the place in a table.
  std::size_t slot() const { return static_cast<std::size_t>(system) * 100 + number; }
};
inline constexpr std::size_t satellite_slots = system_count * 100;

template <class Archive>
void archive(Archive& ar, Satellite& s) {
  ar(s.system, s.number);
  if constexpr (Archive::loading) {
    if (static_cast<int>(s.system) >= system_count || s.number > 99) ar.fail("no satellite");
  }
}

// "G05"; a blank letter is GPS's and a blank tens digit zero, as in old files.
std::optional<Satellite> parse_satellite(std::string_view text);
std::string to_string(Satellite satellite);

// Hz of a RINEX 3 band ('1' to '9'); 0 where the system has none, or GLONASS's channel is unknown.
double carrier_frequency(System system, char band, std::optional<int> glonass_channel = {});

}  // namespace maploop::ppp
