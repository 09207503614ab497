// RINEX navigation files 2.10 to 2.12 and 3.00 to 3.05.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "ppp/readers/ionosphere_message.h"
#include "ppp/readers/lines.h"
#include "ppp/satellite.h"

namespace maploop::ppp {

// What data_sources says of Galileo's two messages: the clock is for E1 and E5a, or E1 and E5b.
inline constexpr double galileo_f_nav = 0x102, galileo_i_nav = 0x205;

// A message of GPS, Galileo, BeiDou or QZSS; names as in IS-GPS-200. rad, m, s.
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
};

// A message of GLONASS: position, velocity and lunisolar acceleration in PZ-90 at `toe`. m, s.
struct GlonassMessage {
  Satellite satellite;
  GpsTime toe{};
  double minus_tau = 0, gamma = 0;
  Eigen::Vector3d position, velocity, acceleration;
  int channel = 0;
  double health = 0;
};

struct BroadcastMessages {
  std::vector<KeplerMessage> kepler;
  std::vector<GlonassMessage> glonass;
  std::vector<IonosphereMessage> ionosphere;

  // All that `from` has, which is empty afterwards; what was here is gone.
  void take(BroadcastMessages& from);
  // Of a stream that nobody takes from: a kind with more than `most` begins anew.
  void limit(std::size_t most);
};

struct NavigationFile : BroadcastMessages {
  std::string file;
  int passed_over = 0;  // messages of SBAS and NavIC, which are not used
  int refused = 0;      // messages whose values cannot be, and one that was cut
  std::vector<std::string> refusals;
};

// Whether it can be a message of a navigation satellite.
bool plausible(const KeplerMessage& message);
bool plausible(const GlonassMessage& message);
// Whether the bits of a message can say these coefficients, and they say something.
bool plausible(const IonosphereCoefficients& coefficients);

// Counts what is left out, and keeps the first reasons. The same of what a stream has at a byte.
void refuse(NavigationFile& navigation, const std::string& place, const std::string& why);
void refuse(NavigationFile& navigation, std::size_t offset, const std::string& why);

NavigationFile parse_navigation(std::string_view text, const std::string& file);

}  // namespace maploop::ppp
