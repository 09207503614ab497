// Defines satellite systems, satellites and carrier frequencies.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "msgs/archive.h"

namespace maploop::ppp {

inline constexpr double speed_of_light = 299792458.0;  // m/s

// Names a satellite system.
enum class System : std::uint8_t { gps, glonass, galileo, beidou, qzss, sbas, navic };
inline constexpr int system_count = 7;  // values of System

// Returns the letter of a system in RINEX: G R E C J S I.
char letter(System system);
// Returns the system of a letter; nothing if it has none.
std::optional<System> system_of(char letter);

// A Satellite is named by its system and its number.
struct Satellite {
  System system = System::gps;  // with `number`, names the satellite
  std::uint8_t number = 0;      // as in RINEX 3, 1 to 99

  // Orders by system, then by number.
  auto operator<=>(const Satellite&) const =
      default;  // NOLINT(modernize-use-nullptr): it takes a generated 0 for a pointer
  // Returns the satellite's index in tables, which is unique and below satellite_slots.
  std::size_t slot() const { return static_cast<std::size_t>(system) * 100 + number; }
};
inline constexpr std::size_t satellite_slots = system_count * 100;  // size of a table by slot()

// A receiver of all systems tracks no more: buffers have room for them from the first epoch on.
inline constexpr std::size_t usual_satellites = 64;

template <class Archive>
void archive(Archive& ar, Satellite& s) {
  ar(s.system, s.number);
  if constexpr (Archive::loading) {
    if (static_cast<int>(s.system) >= system_count || s.number > 99)
      ar.fail("a number that is not a satellite's");
  }
}

// Parses "G05". As in old files, a blank letter stands for GPS and a blank tens digit for zero.
std::optional<Satellite> parse_satellite(std::string_view text);
// Formats as "G05".
std::string to_string(Satellite satellite);

// Returns the bands of a system's ionosphere-free pair, which its precise products refer to.
std::array<char, 2> bands_of(System system);

// Returns the frequency (Hz) of a RINEX 3 band ('1' to '9'); 0 if the system does not have the
// band, or the GLONASS channel is needed and unknown.
double carrier_frequency(System system, char band, std::optional<int> glonass_channel = {});

}  // namespace maploop::ppp
