// Compares the positions with and without the map over the same epochs.
#pragma once

#include <cstddef>
#include <optional>

#include "ppp/filter/solution.h"
#include "tools/ppp/truth.h"

namespace maploop::gnss {

// Counts the epochs of a moving receiver whose position without the map is uncertain across the
// way: elsewhere a map has nothing to give.
class MapComparison {
 public:
  static constexpr double useful = 0.59;      // m, standard deviation across without the map
  static constexpr double stays_below = 1.5;  // m across

  struct Errors {
    double across_rmse = 0.0, horizontal_rmse = 0.0;  // m
    double stays_below_after = 0.0;                   // s until it does, of all that move
  };

  // Epochs before `from` do not count.
  MapComparison(const Truth& truth, std::optional<ppp::GpsTime> from)
      : truth_(truth), from_(from) {}

  void add(const ppp::PppSolution& aided, const ppp::PppSolution& free);

  std::size_t epochs() const { return epochs_; }
  Errors aided() const { return errors_of(aided_); }
  Errors free() const { return errors_of(free_); }

 private:
  struct Sums {
    double across = 0.0, horizontal = 0.0;  // m^2
    ppp::GpsTime above{};                   // when it was above the limit for the last time
  };
  Errors errors_of(const Sums& sums) const;

  const Truth& truth_;
  std::optional<ppp::GpsTime> from_;
  Sums aided_, free_;
  std::size_t epochs_ = 0;
};

}  // namespace maploop::gnss
