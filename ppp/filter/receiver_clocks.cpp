#include "ppp/filter/receiver_clocks.h"

#include <cmath>

#include "msgs/median.h"

namespace maploop::ppp {
namespace {

using S = FilterState;

// The first of these that is seen becomes the reference.
constexpr std::array systems_by_preference{System::gps,  System::galileo, System::beidou,
                                           System::qzss, System::glonass, System::sbas,
                                           System::navic};

std::size_t system_of(const Tracked& t) {
  return static_cast<std::size_t>(t.measurement.satellite.system);
}

}  // namespace

template <class Which, class Value>
std::optional<double> ReceiverClocks::median_of(const std::vector<Tracked>& tracked, Which&& which,
                                                Value&& value) {
  sorted_.clear();
  for (const Tracked& t : tracked) {
    if (which(t)) sorted_.push_back(value(t));
  }
  return sorted_.empty() ? std::optional<double>{} : median(sorted_);
}

void ReceiverClocks::reopen(System source, double sigma, FilterState& state) const {
  const int own = static_cast<int>(source);
  for (int s = 0; s < system_count; ++s) {
    const int offset = S::system_offset + s;
    const bool against_it = own == reference_system_ ? s != own : s == own;
    if (against_it && seen_[static_cast<std::size_t>(s)])
      state.set(offset, state.x()[offset], sigma);
  }
}

void ReceiverClocks::set(std::vector<Tracked>& tracked, const PppParameters& parameters,
                         FilterState& state, std::vector<SatelliteReport>& reports) {
  for (const Tracked& t : tracked) {
    if (t.new_source) reopen(t.measurement.satellite.system, parameters.clock_sigma, state);
  }
  const auto offset = [&](const Tracked& t) {
    return state.x()[S::system_offset + static_cast<int>(system_of(t))];
  };
  auto clock = median_of(
      tracked, [&](const Tracked& t) { return seen_[system_of(t)]; },
      [&](const Tracked& t) { return t.code_offset - offset(t); });
  for (const System system : systems_by_preference) {
    const auto s = static_cast<std::size_t>(system);
    if (seen_[s]) continue;
    const auto own = median_of(
        tracked, [&](const Tracked& t) { return system_of(t) == s; },
        [](const Tracked& t) { return t.code_offset; });
    if (!own) continue;
    seen_[s] = true;
    if (!clock) {
      clock = own;
      reference_system_ = static_cast<int>(s);
    } else {
      const double difference = *own - *clock, usual = parameters.clock_difference_sigma;
      const bool is_usual = std::abs(difference) <= 3.0 * usual;
      state.set(S::system_offset + static_cast<int>(s), is_usual ? 0.0 : difference,
                is_usual ? usual : parameters.clock_sigma);
    }
  }
  if (!clock) return;
  state.set(S::clock, *clock, parameters.clock_sigma);
  // After a gap, the position may be wrong by its own standard deviation, which widens the gate.
  const double lost = std::sqrt(state.P().block<3, 3>(S::position, S::position).trace());
  const double gate = parameters.code_gate + parameters.code_gate_sigmas * lost;
  for (Tracked& t : tracked) {
    if (std::abs(t.code_offset - offset(t) - *clock) > gate) {
      t.code_good = t.phase_good = false;
      reports[t.measurement.report].refused = PppRefusal::code_far;
    }
  }
}

}  // namespace maploop::ppp
