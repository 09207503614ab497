// Writes the calibrations of the antennas.
#include "tools/simulate/gnss/product_text.h"
#include "tools/simulate/gnss/receiver.h"
#include "tools/simulate/gnss/rinex_text.h"

namespace maploop::simulate {
namespace {

struct CarrierText {
  char system, band;
  Eigen::Vector3d offset;  // m: north, east, up; for a satellite along its axes
};

template <std::size_t count>
std::string carrier_text(const CarrierText& c, const std::array<double, count>& variation) {
  const std::string name = fmt::format("   {}0{}", c.system, c.band);
  std::string text = header_line(name, "START OF FREQUENCY");
  text += header_line(fmt::format("{:10.2f}{:10.2f}{:10.2f}", 1e3 * c.offset.x(),
                                  1e3 * c.offset.y(), 1e3 * c.offset.z()),
                      "NORTH / EAST / UP");
  text += "   NOAZI";
  for (const double v : variation) text += fmt::format("{:8.2f}", 1e3 * v);
  return text + '\n' + header_line(name, "END OF FREQUENCY");
}

std::string begin_text(const std::string& type, const char* zenith) {
  std::string text = header_line("", "START OF ANTENNA");
  text += header_line(type, "TYPE / SERIAL NO");
  text += header_line("     0.0", "DAZI");
  text += header_line(zenith, "ZEN1 / ZEN2 / DZEN");
  return text + header_line("     2", "# OF FREQUENCIES");
}

std::string satellite_text(const TrueSatellite& s) {
  const bool galileo = s.satellite.system == ppp::System::galileo;
  std::string type = galileo ? "SIMULATED GALILEO" : "SIMULATED GPS";
  type.resize(20, ' ');
  std::string text = begin_text(type + to_string(s.satellite), "     0.0  14.0   1.0");
  text += header_line("  2020     1     1     0     0    0.0000000", "VALID FROM");
  for (std::size_t i = 0; i < 2; ++i)
    text += carrier_text({letter(s.satellite.system),
                          bands(s.satellite.system)[i],
                          {0.0, 0.0, s.antennas[i].phase_centre}},
                         s.antennas[i].variation);
  return text + header_line("", "END OF ANTENNA");
}

std::string receiver_text() {
  const auto antenna = calibrated_antenna();
  std::string text = begin_text(antenna_type, "     0.0  90.0   5.0");
  for (const ppp::System system : {ppp::System::gps, ppp::System::galileo})
    for (std::size_t i = 0; i < 2; ++i) {
      const Eigen::Vector3d& o = antenna[i].offset;
      text += carrier_text({letter(system), bands(system)[i], {o.y(), o.x(), o.z()}},
                           antenna[i].variation);
    }
  return text + header_line("", "END OF ANTENNA");
}

}  // namespace

std::string antenna_text(const Constellation& constellation) {
  std::string text = header_line("     1.4            M", "ANTEX VERSION / SYST");
  text += header_line("A", "PCV TYPE / REFANT");
  text += header_line("", "END OF HEADER");
  for (const TrueSatellite& s : constellation.satellites()) text += satellite_text(s);
  return text + receiver_text();
}

}  // namespace maploop::simulate
