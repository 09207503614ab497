#include "ppp/unused_signals.h"

#include <algorithm>

namespace maploop::ppp {

std::vector<std::string> unused_systems(const ObservationHeader& header) {
  std::vector<std::string> lines;
  if (header.version < 3.0) return lines;  // its columns are those of all systems
  for (std::size_t s = 0; s < header.types.size(); ++s) {
    const auto system = static_cast<System>(s);
    const auto& types = header.types[s];
    const char band = bands_of(system)[0];
    const bool used = std::ranges::any_of(types, [band](const ObservationType& type) {
      return type.kind == 'C' && type.band == band;
    });
    if (types.empty() || used) continue;
    std::string names;
    for (const ObservationType& type : types) {
      names += ' ';
      names += {type.kind, type.band, type.attribute};
    }
    lines.push_back(std::string("no satellite of system ") + letter(system) +
                    " is used: of its observations (" + names.substr(1) +
                    ") none is a code on its " + "first carrier (C" + band + "*)");
  }
  return lines;
}

}  // namespace maploop::ppp
