// How strong a receiver's signals are without obstacles.
#pragma once

#include <array>
#include <cstddef>

#include "ppp/filter/parameters.h"

namespace maploop::ppp {

// By elevation: what all receivers reach, and where this one's signals turn out to be stronger,
// that: `full_cn0_margin` below what three quarters of them do not exceed.
class FullStrength {
 public:
  explicit FullStrength(const PppParameters& parameters);

  // dB-Hz, at the sine of an elevation; 0 where it does not count.
  double of(double sine) const;
  void add(double sine, double cn0);

  template <class Archive>
  void archive(Archive& ar) {
    ar(quartile_);
  }

 private:
  double of_all(double sine) const;
  static std::size_t band(double sine);

  double zenith_, drop_, margin_;
  std::array<double, 4> quartile_;  // dB, the upper one, beyond of_all(); by elevation
};

}  // namespace maploop::ppp
