#include "ppp/readers/streams/epoch_builder.h"

#include <cmath>

namespace maploop::ppp {

namespace {

void refuse_because(Observations& observations, const std::string& reason) {
  constexpr std::size_t max_reasons = 20;
  ++observations.refused;
  if (observations.refusals.size() < max_reasons) observations.refusals.push_back(reason);
}

}  // namespace

void refuse(Observations& observations, const Lines& lines, const std::string& why) {
  refuse_because(observations,
                 lines.file() + ":" + std::to_string(lines.line_number()) + ": " + why);
}

void refuse(Observations& observations, const ReadError& error) {
  refuse_because(observations, error.what());
}

void refuse(Observations& observations, std::size_t offset, const std::string& why) {
  refuse_because(observations, observations.file + ": byte " + std::to_string(offset) + ": " + why);
}

void append_satellite(Observations& observations, const Lines& lines, Satellite satellite,
                      std::span<const Value> values, Epoch& epoch) {
  const auto system = static_cast<std::size_t>(satellite.system);
  const auto& types = observations.header.types[system];
  if (types.empty()) {
    refuse(observations, lines, "the header has no observation types for " + to_string(satellite));
    return;
  }
  for (const SatelliteSignals& other : epoch.satellites) {
    if (other.satellite == satellite) {
      refuse(observations, lines, to_string(satellite) + " occurs twice in one epoch");
      return;
    }
  }
  const auto first = epoch.signals.size();
  epoch.signals.resize(first + static_cast<std::size_t>(observations.header.signals_of[system]));
  for (std::size_t i = 0; i < types.size() && i < values.size(); ++i) {
    const ObservationType& type = types[i];
    if (type.signal < 0) continue;
    Signal& signal = epoch.signals[first + static_cast<std::size_t>(type.signal)];
    signal.band = type.band;
    signal.attribute = type.attribute;
    if (values[i].value == 0.0) continue;  // another column may have this signal, too
    const double value = values[i].value / type.factor;
    if (type.kind == 'C') {
      // No navigation satellite is nearer than 15000 km or farther than 80000 km, apart from the
      // clocks.
      if (!(value > 1.0e7 && value < 1.0e8)) {
        refuse(observations, lines,
               to_string(satellite) + ": " + shown(value) +
                   " m is not a pseudorange (10000 to 100000 km)");
        continue;
      }
      signal.code = value;
    } else if (type.kind == 'L') {
      signal.phase = value;
      if (values[i].lli > '0' && values[i].lli <= '7') {
        signal.lost_lock = ((values[i].lli - '0') & 1) != 0;
        signal.half_cycle = ((values[i].lli - '0') & 2) != 0;
      }
    } else if (type.kind == 'D') {
      signal.doppler = value;
    } else {
      signal.cn0 = value;
    }
  }
  auto last = first;
  for (auto i = first; i < epoch.signals.size(); ++i) {
    const Signal& s = epoch.signals[i];
    if (s.code != 0.0 || s.phase != 0.0) epoch.signals[last++] = s;
  }
  epoch.signals.resize(last);
  if (last > first) {
    epoch.satellites.push_back(
        {satellite, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last - first)});
  }
}

}  // namespace maploop::ppp
