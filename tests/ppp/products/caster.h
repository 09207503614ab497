// Makes corrections of orbits and clocks from precise products, as the messages of a caster.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ppp/gnss_files.h"
#include "ppp/models/antenna.h"
#include "ppp/models/attitude.h"
#include "ppp/models/earth.h"
#include "ppp/products/corrected.h"
#include "tests/support/gnss_messages.h"
#include "tests/support/real_data.h"

namespace maploop::ppp {

inline std::filesystem::path kamakura_folder() {
  return maploop::testing::real_data() / "gnss/kamakura_kinematic";
}

inline const GnssFiles& kamakura() {
  static const GnssFiles files = [] {
    GnssFiles f;
    for (const char* name :
         {"SEPT265G.21O.gz", "SEPT2650.21P.gz", "../models/igs14_rebuilt_GE.atx.gz",
          "COD0MGXFIN_20212650000_01D_05M_ORB.SP3.gz",
          "COD0MGXFIN_20212650000_01D_01D_OSB.BIA.gz"}) {
      read_into(kamakura_folder() / name, f);
    }
    return f;
  }();
  return files;
}

// A Caster makes corrections from the precise products of the car in Kamakura.
class Caster {
 public:
  Caster()
      : precise_(kamakura().orbits, kamakura().clocks, kamakura().biases),
        broadcast_(kamakura().navigation),
        earth_(kamakura().earth_rotation) {}

  std::string messages(maploop::testing::SsrForm form, GpsTime epoch) const {
    std::string bytes;
    for (const System system : {System::gps, System::galileo}) {
      std::vector<SsrUpdate> updates;
      for (int n = 1; n <= 36; ++n) {
        if (auto u = update({system, static_cast<std::uint8_t>(n)}, epoch)) updates.push_back(*u);
      }
      // A message has at most 1023 bytes.
      for (std::size_t i = 0; i < updates.size(); i += 20) {
        const auto end = updates.begin() + static_cast<long>(std::min(updates.size(), i + 20));
        bytes += maploop::testing::ssr_orbits_and_clocks(
            form, system, epoch, {updates.begin() + static_cast<long>(i), end});
      }
      bytes += maploop::testing::ssr_biases(
          system, epoch, biases(system, [&](Satellite satellite, char band, char attribute) {
            return precise_.code_bias(satellite, band, attribute, epoch);
          }));
    }
    return bytes;
  }

  // Returns the biases of phases, which have jumped `jumps` times.
  std::string phase_biases(maploop::testing::SsrForm form, GpsTime epoch,
                           std::uint64_t jumps = 0) const {
    std::string bytes;
    for (const System system : {System::gps, System::galileo}) {
      bytes += maploop::testing::ssr_phase_biases(
          form, system, epoch,
          biases(system,
                 [&](Satellite satellite, char band, char attribute) {
                   return precise_.phase_bias(satellite, band, attribute, epoch).value_or(0.0);
                 }),
          jumps);
    }
    return bytes;
  }

  std::optional<SsrUpdate> update(Satellite satellite, GpsTime epoch) const {
    const GpsTime t = epoch + std::chrono::milliseconds(2500);
    const auto now = difference(satellite, t),
               soon = difference(satellite, t + std::chrono::seconds(1));
    if (!now || !soon) return {};
    SsrUpdate u;
    u.satellite = satellite;
    u.orbit = SsrOrbit{now->issue, now->offset, soon->offset - now->offset};
    u.clock = SsrClock{{now->clock, soon->clock - now->clock, 0.0}};
    return u;
  }

  // Returns the phase centre of the ionosphere-free combination, which codes and clocks refer to.
  Eigen::Vector3d phase_centre(Satellite satellite, const Eigen::Vector3d& mass, GpsTime t) const {
    const Antenna* antenna = SatelliteAntennas(kamakura().antennas, t).of(satellite);
    if (antenna == nullptr) return mass;
    const Eigen::Matrix3d attitude = nominal_attitude(mass, earth_.at(t).sun);
    const auto bands = bands_of(satellite.system);
    const double f1 = carrier_frequency(satellite.system, bands[0]);
    const double f2 = carrier_frequency(satellite.system, bands[1]);
    const double w = f1 * f1 / (f1 * f1 - f2 * f2);
    const auto offset = [&](char band) {
      const PhaseCentre* c = antenna->carrier(satellite.system, band);
      return c != nullptr ? c->offset : antenna->carriers.front().offset;
    };
    return mass + attitude * (w * offset(bands[0]) + (1.0 - w) * offset(bands[1]));
  }

  const PreciseEphemeris& precise() const { return precise_; }

 private:
  struct Difference {
    int issue;
    Eigen::Vector3d offset;
    double clock;
  };
  // A receiver would have the newest message by then; here it is the nearest.
  std::optional<Difference> difference(Satellite satellite, GpsTime t) const {
    const auto precise = precise_.at(satellite, t);
    const auto near = broadcast_.at(satellite, t);
    if (!precise || !near) return {};
    for (int issue = 0; issue < 256; ++issue) {
      const auto said = broadcast_.at_issue(satellite, issue, t);
      if (!said || said->position != near->position) continue;
      const Eigen::Vector3d along = said->velocity.normalized();
      const Eigen::Vector3d across = said->position.cross(said->velocity).normalized();
      const Eigen::Vector3d d = said->position - phase_centre(satellite, precise->position, t);
      return Difference{issue,
                        {along.cross(across).dot(d), along.dot(d), across.dot(d)},
                        speed_of_light * (precise->clock - said->clock)};
    }
    return {};
  }

  // Returns the biases that are not 0, as messages send them.
  template <class BiasOf>
  static std::vector<maploop::testing::NumberedBias> biases(System system, BiasOf bias_of) {
    struct Code {
      int signal;
      char band, attribute;
    };
    const std::vector<Code> codes =
        system == System::gps
            ? std::vector<Code>{{0, '1', 'C'}, {2, '1', 'W'}, {8, '2', 'L'}, {11, '2', 'W'}}
            : std::vector<Code>{{2, '1', 'C'}, {6, '5', 'Q'}};
    std::vector<maploop::testing::NumberedBias> all;
    for (std::uint8_t n = 1; n <= 36; ++n) {
      for (const Code& c : codes) {
        const double bias = bias_of(Satellite{system, n}, c.band, c.attribute);
        if (bias != 0.0) all.push_back({n, c.signal, -bias});
      }
    }
    return all;
  }

  PreciseEphemeris precise_;
  BroadcastEphemeris broadcast_;
  mutable Earth earth_;  // keeps the last moment
};

inline const Caster& caster() {
  static const Caster c;
  return c;
}

}  // namespace maploop::ppp
