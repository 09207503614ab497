#include "tools/gnss/reach.h"

#include <stdexcept>

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

}  // namespace

std::string reach(const ppp::GnssFiles& files) {
  if (files.observations.size() != 1) return {};
  std::string text = "together\n";
  try {
    const ppp::PppSetup setup(files, {});
    text += "  reach         " + level(setup) + '\n';
    for (const std::string& lack : setup.missing_models()) text += "  lack          " + lack + '\n';
  } catch (const std::runtime_error& error) {
    text += std::string("  lack          ") + error.what() + '\n';
  }
  return text;
}

}  // namespace maploop::gnss
