#include "tools/simulate/gnss/product_text.h"

#include <array>
#include <cmath>
#include <numbers>

#include "tools/simulate/gnss/rinex_text.h"
#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

// A slowly changing error, like those of orbits and clocks: the sum of two waves with periods of 3
// to 14 hours. `sigma` is its root mean square over time.
class SlowError {
 public:
  SlowError(double sigma, Random& random) {
    for (Wave& wave : waves_)
      wave = {2.0 * std::numbers::pi / (3600.0 * random.uniform(3.0, 14.0)),
              random.uniform(0.0, 2.0 * std::numbers::pi), sigma};
  }

  double at(double t) const {
    double sum = 0.0;
    for (const Wave& wave : waves_) sum += wave.size * std::sin(wave.number * t + wave.phase);
    return sum;
  }

 private:
  struct Wave {
    double number, phase, size;  // rad/s, rad
  };
  std::array<Wave, 2> waves_;
};

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
  // The orbit's lines of the message, from its issue of data to the end.
  const double orbit[7][4] = {{number, o.crs, delta_n, within_pi(mean)},
                              {o.cuc, o.eccentricity, o.cus, std::sqrt(a)},
                              {toe_of_week, o.cic, within_pi(node), o.cis},
                              {inclination, o.crc, within_pi(o.perigee), o.node_rate},
                              {o.inclination_rate, galileo ? 258.0 : 1.0, week, 0.0},
                              {galileo ? 3.12 : 2.0, 0.0, delay, galileo ? 0.0 : number},
                              {toe_of_week - 600.0, galileo ? 0.0 : 4.0, 0.0, 0.0}};
  std::string text =
      to_string(s.satellite) + ' ' + stamp_text(stamp, " {:02.0f}") +
      fmt::format("{:19.12E}{:19.12E}{:19.12E}", clock + error.clock.at(toe) / ppp::speed_of_light,
                  s.clock_drift, 0.0);
  for (const auto& line : orbit) {
    text += "\n    ";
    for (const double value : line) text += fmt::format("{:19.12E}", value);
  }
  return text + '\n';
}

constexpr double orbit_interval = 300.0, clock_interval = 30.0;  // s
constexpr double orbit_margin = 4200.0, clock_margin = 300.0;    // s

// Returns the last multiple of `interval` of the week at least `margin` before the span, in seconds
// since the span's start.
double round_begin(const ProductSpan& span, double interval, double margin) {
  const double of_week = ppp::seconds_of_week(span.start);
  return std::floor((of_week - margin) / interval) * interval - of_week;
}

ppp::GpsTime moment(const ProductSpan& span, double t) {
  return span.start + from_seconds(t);
}

// The columns are the unit vectors away from the earth, along the motion, and across it.
Eigen::Matrix3d orbit_axes(const OrbitElements& orbit, double t) {
  const Eigen::Vector3d p = orbit.position(t);
  const Eigen::Vector3d out = p.normalized();
  const Eigen::Vector3d across = p.cross(orbit.velocity(t)).normalized();
  Eigen::Matrix3d axes;
  axes << out, across.cross(out), across;
  return axes;
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

std::string orbit_text(const Constellation& constellation, const ProductSpan& span,
                       std::uint64_t seed) {
  const auto& satellites = constellation.satellites();
  const double begin = round_begin(span, orbit_interval, orbit_margin);
  const auto epochs = static_cast<int>((span.seconds + orbit_margin - begin) / orbit_interval) + 1;
  const ppp::GpsTime first = moment(span, begin);
  std::string text =
      "#cP" + stamp_text(first, "{:12.8f}") + fmt::format(" {:7} ORBIT IGS20 SIM SIMU\n", epochs);
  const double days = std::floor(to_seconds(first.time_since_epoch()) / 86400.0);
  const double of_day = to_seconds(first.time_since_epoch()) - 86400.0 * days;
  text +=
      fmt::format("## {:4} {:15.8f} {:14.8f} {:5.0f} {:15.13f}\n", ppp::gps_week(first),
                  ppp::seconds_of_week(first), orbit_interval, 44244.0 + days, of_day / 86400.0);
  for (const bool accuracy : {false, true})
    for (std::size_t line = 0; line < 5; ++line) {
      text += accuracy    ? "++       "
              : line == 0 ? fmt::format("+  {:3}   ", satellites.size())
                          : "+        ";
      for (std::size_t i = 17 * line; i < 17 * (line + 1); ++i)
        text += i >= satellites.size() ? "  0"
                : accuracy             ? "  4"
                                       : to_string(satellites[i].satellite);
      text += '\n';
    }
  text +=
      "%c M  cc GPS ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc\n"
      "%c cc cc ccc ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc\n"
      "%f  0.0000000  0.000000000  0.00000000000  0.000000000000000\n"
      "%f  0.0000000  0.000000000  0.00000000000  0.000000000000000\n"
      "%i    0    0    0    0      0      0      0      0         0\n"
      "%i    0    0    0    0      0      0      0      0         0\n"
      "/* made by maploop simulate                                 \n";
  std::vector<std::array<SlowError, 3>> errors;
  Random random(seed, 26);
  for (std::size_t i = 0; i < satellites.size(); ++i)
    errors.push_back(
        {SlowError(0.012, random), SlowError(0.012, random), SlowError(0.012, random)});
  for (int epoch = 0; epoch < epochs; ++epoch) {
    const double t = begin + orbit_interval * epoch;
    text += "*  " + stamp_text(moment(span, t), "{:12.8f}") + '\n';
    for (std::size_t i = 0; i < satellites.size(); ++i) {
      const OrbitElements& orbit = satellites[i].orbit;
      const Eigen::Vector3d off(errors[i][0].at(t), errors[i][1].at(t), errors[i][2].at(t));
      const Eigen::Vector3d p = 1e-3 * (orbit.position(t) + orbit_axes(orbit, t) * off);
      text += 'P' + to_string(satellites[i].satellite) +
              fmt::format("{:14.6f}{:14.6f}{:14.6f}{:14.6f}\n", p.x(), p.y(), p.z(), 999999.999999);
    }
  }
  return text + "EOF\n";
}

std::string clock_text(const Constellation& constellation, const ProductSpan& span,
                       std::uint64_t seed) {
  const auto& satellites = constellation.satellites();
  std::string text;
  text += header_line("     3.00           C                   M", "RINEX VERSION / TYPE");
  text += header_line("maploop simulate", "PGM / RUN BY / DATE");
  text += header_line("   GPS", "TIME SYSTEM ID");
  text += header_line("     1    AS", "# / TYPES OF DATA");
  text += header_line("SIM  simulated", "ANALYSIS CENTER");
  text += header_line("", "END OF HEADER");
  std::vector<SlowError> errors;
  Random random(seed, 27);
  for (std::size_t i = 0; i < satellites.size(); ++i) errors.emplace_back(0.015, random);
  for (double t = round_begin(span, clock_interval, clock_margin);
       t < span.seconds + clock_margin + clock_interval; t += clock_interval) {
    const std::string stamp = stamp_text(moment(span, t), "{:10.6f}");
    for (std::size_t i = 0; i < satellites.size(); ++i)
      text += "AS " + to_string(satellites[i].satellite) + "  " + stamp + "  1   " +
              fmt::format("{:19.12E}\n",
                          constellation.clock(i, t) + errors[i].at(t) / ppp::speed_of_light);
  }
  return text;
}

}  // namespace maploop::simulate
