// Sets the receiver's clock and the offsets of the systems' clocks from the codes of an epoch.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "ppp/filter/filter_state.h"
#include "ppp/filter/parameters.h"
#include "ppp/filter/satellite_tracker.h"

namespace maploop::ppp {

// The receiver's clock is that against the reference system, the first one that is seen. Every
// other system has an offset against it, a state of the filter from its first epoch on.
class ReceiverClocks {
 public:
  void reset() { *this = {}; }
  int reference_system() const { return reference_system_; }  // -1: none yet

  // Sets the clock, and the offsets of new systems, from the medians of the codes. Codes far from
  // the median are refused. After a change of source, the new clocks count from another origin,
  // which the system's offset absorbs (for the reference system, all other offsets).
  void set(std::vector<Tracked>& tracked, const PppParameters& parameters, FilterState& state,
           std::vector<SatelliteReport>& reports);

  template <class Archive>
  void archive(Archive& ar) {
    ar(reference_system_, seen_);
    if constexpr (Archive::loading) {
      if (reference_system_ < -1 || reference_system_ >= system_count)
        ar.fail("not a reference system");
    }
  }

 private:
  void reopen(System source, double sigma, FilterState& state) const;
  template <class Which, class Value>
  std::optional<double> median_of(const std::vector<Tracked>& tracked, Which&& which,
                                  Value&& value);

  int reference_system_ = -1;
  std::array<bool, system_count> seen_{};
  std::vector<double> sorted_;  // a member only to reuse its memory
};

}  // namespace maploop::ppp
