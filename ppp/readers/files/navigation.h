// Reads RINEX navigation files 2.00 to 2.12, 3.00 to 3.05 and 4.00 to 4.02.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "ppp/readers/files/lines.h"
#include "ppp/readers/streams/ionosphere_message.h"
#include "ppp/satellite.h"

namespace maploop::ppp {

// These values of data_sources mark Galileo's two messages: the clock is for E1 and E5a, or E1 and
// E5b.
inline constexpr double galileo_f_nav = 0x102, galileo_i_nav = 0x205;

// A KeplerMessage is a message of GPS, Galileo, BeiDou or QZSS, with names as in IS-GPS-200. Units
// are rad, m, s.
struct KeplerMessage {
  Satellite satellite;
  GpsTime toc{}, toe{};
  double af0 = 0, af1 = 0, af2 = 0;
  double iode = 0, crs = 0, delta_n = 0, m0 = 0;
  double cuc = 0, e = 0, cus = 0, sqrt_a = 0;
  double cic = 0, omega0 = 0, cis = 0;
  double i0 = 0, crc = 0, omega = 0, omega_dot = 0, i_dot = 0;
  double data_sources = 0;  // Galileo: which signals the clock is for
  double accuracy = 0;      // m
  double health = 0;
  std::array<double, 2> group_delay{};  // s: TGD; Galileo's BGD E5a/E1, E5b/E1; BeiDou's TGD1, TGD2

  void archive(auto& ar) {
    ar(satellite, toc, toe, af0, af1, af2, iode, crs, delta_n, m0, cuc, e, cus, sqrt_a, cic, omega0,
       cis, i0, crc, omega, omega_dot, i_dot, data_sources, accuracy, health, group_delay);
  }
};

// A GlonassMessage contains position, velocity and lunisolar acceleration in PZ-90 at `toe`. Units
// are m, s.
struct GlonassMessage {
  Satellite satellite;
  GpsTime toe{};
  double minus_tau = 0, gamma = 0;
  Eigen::Vector3d position, velocity, acceleration;
  int channel = 0;
  double health = 0;

  void archive(auto& ar) {
    ar(satellite, toe, minus_tau, gamma, position, velocity, acceleration, channel, health);
  }
};

struct BroadcastMessages {
  std::vector<KeplerMessage> kepler;
  std::vector<GlonassMessage> glonass;
  std::vector<IonosphereMessage> ionosphere;

  // Takes everything from `from`, which is then empty, and discards the previous content.
  void take(BroadcastMessages& from);
  // Limits the memory of a stream whose messages are not taken: clears each list with more than
  // `most`.
  void limit(std::size_t most);
};

struct NavigationFile : BroadcastMessages {
  std::string file;
  int skipped = 0;  // messages that are not used: SBAS, NavIC, CNAV and others of RINEX 4
  int refused = 0;  // messages with invalid values, and an incomplete one
  std::vector<std::string> refusals;
};

// Both return whether the message can be that of a navigation satellite.
bool plausible(const KeplerMessage& message);
bool plausible(const GlonassMessage& message);
// Returns whether the bits of a message can represent these coefficients, and at least one is not
// zero.
bool plausible(const IonosphereCoefficients& coefficients);

// Counts what is left out and keeps the first reasons; the second form is for a stream, with the
// offset of a byte.
void refuse(NavigationFile& navigation, const std::string& place, const std::string& why);
void refuse(NavigationFile& navigation, std::size_t offset, const std::string& why);

NavigationFile parse_navigation(std::string_view text, const std::string& file);

}  // namespace maploop::ppp
