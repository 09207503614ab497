#include "tools/simulate/gnss/product_text.h"

#include <cmath>
#include <numbers>

#include "tools/simulate/gnss/rinex_text.h"
#include "tools/simulate/gnss/slow_error.h"

namespace maploop::simulate {
namespace {

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

std::string orbit_text(const Constellation& constellation, const ProductSpan& span,
                       std::uint64_t seed) {
  const auto& satellites = constellation.satellites();
  const double begin = round_begin(span, orbit_interval, orbit_margin);
  const auto epochs = static_cast<int>((span.seconds + orbit_margin - begin) / orbit_interval) + 1;
  const ppp::GpsTime first = moment(span, begin);
  std::string text =
      "#cP" + stamp_text(first, "%12.8f") + formatted(" %7d ORBIT IGS20 SIM SIMU\n", epochs);
  const double days = std::floor(to_seconds(first.time_since_epoch()) / 86400.0);
  const double of_day = to_seconds(first.time_since_epoch()) - 86400.0 * days;
  text += formatted("## %4d %15.8f %14.8f %5.0f %15.13f\n", ppp::gps_week(first),
                    ppp::seconds_of_week(first), orbit_interval, 44244.0 + days, of_day / 86400.0);
  for (std::size_t line = 0; line < 5; ++line) {
    text += line == 0 ? formatted("+  %3d   ", static_cast<int>(satellites.size())) : "+        ";
    for (std::size_t i = 17 * line; i < 17 * (line + 1); ++i)
      text += i < satellites.size() ? to_string(satellites[i].satellite) : "  0";
    text += '\n';
  }
  for (std::size_t line = 0; line < 5; ++line) {
    text += "++       ";
    for (std::size_t i = 17 * line; i < 17 * (line + 1); ++i)
      text += i < satellites.size() ? "  4" : "  0";
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
    text += "*  " + stamp_text(moment(span, t), "%12.8f") + '\n';
    for (std::size_t i = 0; i < satellites.size(); ++i) {
      const OrbitElements& orbit = satellites[i].orbit;
      const Eigen::Vector3d off(errors[i][0].at(t), errors[i][1].at(t), errors[i][2].at(t));
      const Eigen::Vector3d p = 1e-3 * (orbit.position(t) + orbit_axes(orbit, t) * off);
      text += 'P' + to_string(satellites[i].satellite) +
              formatted("%14.6f%14.6f%14.6f%14.6f\n", p.x(), p.y(), p.z(), 999999.999999);
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
    const std::string stamp = stamp_text(moment(span, t), "%10.6f");
    for (std::size_t i = 0; i < satellites.size(); ++i)
      text +=
          "AS " + to_string(satellites[i].satellite) + "  " + stamp + "  1   " +
          formatted("%19.12E\n", constellation.clock(i, t) + errors[i].at(t) / ppp::speed_of_light);
  }
  return text;
}

}  // namespace maploop::simulate
