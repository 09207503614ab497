// Writes maps of the ionosphere as IONEX, for tests.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>

namespace maploop::ppp::testing {

// These are maps of a day of 2020, two hours apart from midnight on, on the usual grid.
struct MadeMaps {
  int month = 6, day = 25, maps = 13;
  // TECU at a latitude and a longitude (deg) at an hour (UTC); NaN: no value.
  std::function<double(double, double, int)> electrons = [](double, double, int) { return 20.0; };
  // The same of the standard deviation; empty: none.
  std::function<double(double, double, int)> sigma = [](double, double, int) { return 1.5; };
};

inline std::string ionex(const MadeMaps& made) {
  const auto line = [](const std::string& content, const char* label) {
    return fmt::format("{:60}{:20}\n", content, label);
  };
  std::string text = line("     1.0            IONOSPHERE MAPS     GPS", "IONEX VERSION / TYPE") +
                     line("   450.0 450.0   0.0", "HGT1 / HGT2 / DHGT") +
                     line("    87.5 -87.5  -2.5", "LAT1 / LAT2 / DLAT") +
                     line("  -180.0 180.0   5.0", "LON1 / LON2 / DLON") +
                     line("    -1", "EXPONENT") + line("", "END OF HEADER");
  const auto add = [&](const auto& of, const std::string& kind) {
    for (int map = 0; of && map < made.maps; ++map) {
      const int hour = 2 * map;
      text += line(fmt::format("{:6}", map + 1), ("START OF " + kind + " MAP").c_str());
      text += line(fmt::format("  2020    {:2}    {:2}    {:2}     0     0", made.month,
                               made.day + hour / 24, hour % 24),
                   "EPOCH OF CURRENT MAP");
      for (int row = 0; row < 71; ++row) {
        const double latitude = 87.5 - 2.5 * row;
        text += line(fmt::format("  {:6.1f}-180.0 180.0   5.0 450.0", latitude),
                     "LAT/LON1/LON2/DLON/H");
        for (int column = 0; column < 73; ++column) {
          const double value = of(latitude, -180.0 + 5.0 * column, hour);
          text += fmt::format("{:5}", std::isnan(value) ? 9999 : std::lround(10.0 * value));
          if (column % 16 == 15 || column == 72) text += '\n';
        }
      }
      text += line(fmt::format("{:6}", map + 1), ("END OF " + kind + " MAP").c_str());
    }
  };
  add(made.electrons, "TEC");
  add(made.sigma, "RMS");
  return text + line("", "END OF FILE");
}

}  // namespace maploop::ppp::testing
