// Estimates how strong a receiver's signals are without obstacles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "ppp/filter/parameters.h"

namespace maploop::ppp {

// The expected unobstructed C/N0 by elevation is the curve common to all receivers. It is raised to
// this receiver's own upper quartile minus `full_cn0_margin` where that is higher.
class UnobstructedCn0 {
 public:
  explicit UnobstructedCn0(const PppParameters& parameters);

  // Returns the C/N0 in dB-Hz at the sine of an elevation; 0 if strength is not used (`full_cn0` =
  // 0).
  double of(double sine) const;
  void add(double sine, double cn0);

  template <class Archive>
  void archive(Archive& ar) {
    ar(quartile_, count_);
  }

 private:
  double of_all(double sine) const;
  static std::size_t band(double sine);

  double zenith_, drop_, margin_, step_, first_step_;
  std::array<double, 4> quartile_;        // dB above of_all(), the upper quartile by elevation band
  std::array<std::uint32_t, 4> count_{};  // of the signals of each band
};

}  // namespace maploop::ppp
