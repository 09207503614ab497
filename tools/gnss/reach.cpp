#include "tools/gnss/reach.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "ppp/filter/measurement.h"
#include "ppp/ppp_setup.h"

namespace maploop::gnss {
namespace {

// The figures are those of an antenna under an open sky (ppp/FIGURES.md).
std::string level(const ppp::PppSetup& setup) {
  if (setup.one_frequency()) {
    return setup.precise() ? "one frequency, precise products: 2 to 4 decimetres"
                           : "one frequency, broadcast orbits: 2 to 6 decimetres";
  }
  if (!setup.precise()) return "two frequencies, broadcast orbits: 2 to 4 decimetres";
  return setup.phase_biases()
             ? "two frequencies, integers: 1 to 2 cm, 0.1 m after 5 to 10 minutes"
             : "two frequencies, real-valued ambiguities: 2 cm, 0.1 m after 8 to 30 minutes";
}

// Returns why satellites cannot be used, if fewer than four can in each of some epochs: the reason
// that is the most frequent one. Returns nothing otherwise.
std::string lack_of_satellites(const ppp::PppSetup& setup) {
  constexpr std::size_t looked_at = 20;
  const ppp::Observations& o = setup.observations();
  const std::array<std::optional<int>, 100>& channels = o.header.glonass_channels;
  std::map<std::string, int> reasons;
  for (std::size_t i = 0; i < looked_at; ++i) {
    const ppp::Epoch& epoch = o.epochs[i * o.epochs.size() / looked_at];
    int usable = 0;
    for (const auto& s : epoch.satellites) {
      const ppp::System system = s.satellite.system;
      if (setup.parameters().systems.find(letter(system)) == std::string::npos) continue;
      if (!measure(s.satellite, epoch.of(s), channels, setup.ephemeris(), epoch.time)) {
        ++reasons[std::string("no code on the first carrier of system ") + letter(system)];
      } else if (!setup.ephemeris().at(s.satellite, epoch.time)) {
        ++reasons[setup.ephemeris().missing(s.satellite, epoch.time)];
      } else {
        ++usable;
      }
    }
    if (usable >= 4) return {};
  }
  const auto most = std::ranges::max_element(reasons, {}, [](const auto& r) { return r.second; });
  return "no epoch has four satellites that can be used" +
         (most == reasons.end() ? std::string{} : "; for instance " + most->first);
}

std::string reach_of_setup(const ppp::PppSetup& setup) {
  const std::string lack = lack_of_satellites(setup);
  if (!lack.empty()) return "  lack          " + lack + '\n';
  std::string text = "  reach         " + level(setup) + '\n';
  for (const std::string& model : setup.missing_models()) text += "  lack          " + model + '\n';
  return text;
}

}  // namespace

std::string reach(const ppp::GnssFiles& files) {
  if (files.observations.size() != 1) return {};
  std::string text = "together\n";
  try {
    const ppp::PppSetup setup(files, {});
    text += reach_of_setup(setup);
  } catch (const std::runtime_error& error) {
    text += std::string("  lack          ") + error.what() + '\n';
  }
  return text;
}

}  // namespace maploop::gnss
