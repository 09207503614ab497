// Writes navigation messages.
#include <array>
#include <cmath>
#include <numbers>

#include "tools/simulate/gnss/product_text.h"
#include "tools/simulate/gnss/rinex_text.h"
#include "tools/simulate/gnss/slow_error.h"

namespace maploop::simulate {
namespace {

// The errors of a message; m, 1 sigma.
struct MessageErrors {
  explicit MessageErrors(bool galileo, Random& random)
      : along(galileo ? 0.3 : 1.0, random),
        across(galileo ? 0.2 : 0.5, random),
        node(galileo ? 0.2 : 0.5, random),
        radial(galileo ? 0.08 : 0.15, random),
        clock(galileo ? 0.2 : 0.4, random) {}
  SlowError along, across, node, radial, clock;
};

double within_pi(double angle) {
  return std::remainder(angle, 2.0 * std::numbers::pi);
}

// Returns the phase centre of the ionosphere-free combination of both carriers, m from the centre
// of mass.
double combined_centre(const TrueSatellite& s) {
  const double f1 = ppp::carrier_frequency(s.satellite.system, bands(s.satellite.system)[0]);
  const double f2 = ppp::carrier_frequency(s.satellite.system, bands(s.satellite.system)[1]);
  const double a = f1 * f1 / (f1 * f1 - f2 * f2);
  return a * s.antennas[0].phase_centre + (1.0 - a) * s.antennas[1].phase_centre;
}

// `toe` is in seconds since the drive's start.
std::string message_text(const TrueSatellite& s, const MessageErrors& error, double clock,
                         double toe, ppp::GpsTime stamp) {
  const bool galileo = s.satellite.system == ppp::System::galileo;
  const OrbitElements& o = s.orbit;
  const double toe_of_week = ppp::seconds_of_week(stamp);
  const double a = o.semi_major_axis - combined_centre(s) + error.radial.at(toe);
  const double earth = galileo ? 3.986004418e14 : 3.9860050e14;  // m^3/s^2, as receivers use it
  constexpr double rotation = 7.2921151467e-5;                   // rad/s, as receivers use it
  const double delta_n = o.mean_motion() - std::sqrt(earth / (a * a * a));
  const double mean = o.mean_anomaly + o.mean_motion() * toe + error.along.at(toe) / a;
  const double node =
      o.node + (o.node_rate - rotation) * toe + rotation * toe_of_week + error.node.at(toe) / a;
  const double inclination = o.inclination + o.inclination_rate * toe + error.across.at(toe) / a;
  const double number = static_cast<double>(static_cast<int>(toe_of_week / 600.0) % 128);
  const double week = ppp::gps_week(stamp);
  const double delay = s.group_delay;
  const std::array<double, 31> values{clock + error.clock.at(toe) / ppp::speed_of_light,
                                      s.clock_drift,
                                      0.0,
                                      number,
                                      o.crs,
                                      delta_n,
                                      within_pi(mean),
                                      o.cuc,
                                      o.eccentricity,
                                      o.cus,
                                      std::sqrt(a),
                                      toe_of_week,
                                      o.cic,
                                      within_pi(node),
                                      o.cis,
                                      inclination,
                                      o.crc,
                                      within_pi(o.perigee),
                                      o.node_rate,
                                      o.inclination_rate,
                                      galileo ? 258.0 : 1.0,
                                      week,
                                      0.0,
                                      galileo ? 3.12 : 2.0,
                                      0.0,
                                      delay,
                                      galileo ? 0.0 : number,
                                      toe_of_week - 600.0,
                                      galileo ? 0.0 : 4.0,
                                      0.0,
                                      0.0};
  std::string text = to_string(s.satellite) + ' ' + stamp_text(stamp, " %02.0f");
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i >= 3 && (i + 1) % 4 == 0) text += "\n    ";
    text += formatted("%19.12E", values[i]);
  }
  return text + '\n';
}

}  // namespace

std::string navigation_text(const Constellation& constellation, const ProductSpan& span,
                            std::uint64_t seed) {
  std::string text;
  text += header_line("     3.04           N: GNSS NAV DATA    M: MIXED", "RINEX VERSION / TYPE");
  text += header_line("maploop simulate", "PGM / RUN BY / DATE");
  text += header_line("GPSA   1.1176E-08  1.4901E-08 -5.9605E-08 -5.9605E-08", "IONOSPHERIC CORR");
  text += header_line("GPSB   8.8064E+04  1.6384E+04 -1.3107E+05 -6.5536E+04", "IONOSPHERIC CORR");
  text += header_line("    18", "LEAP SECONDS");
  text += header_line("", "END OF HEADER");
  const auto& satellites = constellation.satellites();
  Random random(seed, 28);
  for (std::size_t i = 0; i < satellites.size(); ++i) {
    const bool galileo = satellites[i].satellite.system == ppp::System::galileo;
    const MessageErrors errors(galileo, random);
    const double interval = galileo ? 600.0 : 7200.0;
    const double of_week = ppp::seconds_of_week(span.start);
    double toe = std::floor(of_week / interval) * interval - of_week;
    for (; toe < span.seconds + interval; toe += interval)
      text += message_text(satellites[i], errors, constellation.clock(i, toe), toe,
                           span.start + from_seconds(toe));
  }
  return text;
}

}  // namespace maploop::simulate
