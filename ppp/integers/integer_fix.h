// Resolves ambiguities to integers, epoch by epoch, and conditions the filter's state on them. The
// filter itself keeps real-valued ambiguities, so that wrong integers end with their epoch.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "ppp/filter/epoch_rows.h"
#include "ppp/filter/filter_state.h"
#include "ppp/integers/lambda.h"
#include "ppp/integers/wide_lanes.h"

namespace maploop::ppp {

// The ambiguities of a satellite's first carrier and of its wide lane (the first less the second
// carrier's), cycles.
using Integers = std::array<double, 2>;

// A satellite whose ambiguities can be integers.
struct IntegerCandidate {
  Satellite satellite;
  std::size_t tracked = 0;           // index into the epoch's tracked satellites
  std::array<int, 2> indices{};      // of its ambiguities of range and ionosphere in the state
  std::array<Integers, 2> cycles{};  // for each metre of these
  std::size_t reference = 0;         // the candidate of its system that it is differenced against
  Eigen::Index difference = -1;      // of its first ambiguity; -1: it has none
  bool differenced() const { return difference >= 0; }
  bool own = false;  // both ambiguities are integers in this solution
};

class IntegerFix {
 public:
  explicit IntegerFix(const PppParameters& parameters);
  void reset();

  // Takes an epoch that the filter has processed. Returns the state given the integers, valid until
  // the next call, or nullptr if they are not certain; `report` states why. Marks the satellites'
  // reports whose integers are used.
  const FilterState* resolve(const FilterState& state, const std::vector<Tracked>& tracked,
                             const std::vector<Row>& rows, GpsTime t, IntegerReport& report,
                             std::vector<SatelliteReport>& satellites);

  static constexpr std::size_t largest_archive =
      satellite_slots * sizeof(WideLanes::Mean) +
      (Lambda::max_size + 2) * Lambda::max_size * sizeof(double) + 1024;
  template <class Archive>
  void archive(Archive& ar) {
    ar(wide_lanes_, last_, unchanged_since_);
  }

 private:
  // The combinations of ambiguities that an epoch has fixed. Shares add up to 0 over a system.
  struct FixedCombinations {
    std::vector<Satellite> satellites;
    std::vector<double> shares;  // for each combination, those of each satellite's two ambiguities
    std::vector<double> integers;

    template <class Archive>
    void archive(Archive& ar) {
      ar(satellites, shares, integers);
      if constexpr (Archive::loading) {
        if (shares.size() != integers.size() * satellites.size() * std::tuple_size_v<Integers>)
          ar.fail("the shares do not match their satellites");
      }
    }
  };
  struct Differences {
    Lambda::Vector values;      // cycles
    Lambda::Matrix covariance;  // cycles^2
  };
  void take(const FilterState& state, const std::vector<Tracked>& tracked,
            const std::vector<Row>& rows);
  void choose_references(const FilterState& state);
  void make_differences();
  void evaluate(const FilterState& state, Differences& result) const;
  void use_wide_lanes();
  int search(IntegerReport& report);
  void condition(const FilterState& state, int count);
  void find_own_integers();
  bool difference_is_integer(const IntegerCandidate& a, const IntegerCandidate& b) const;
  bool agrees_with_last() const;
  void remember(int count);
  void restart(Satellite satellite);

  PppParameters parameters_;
  WideLanes wide_lanes_;
  FixedCombinations last_;
  std::optional<GpsTime> unchanged_since_;  // no integer has changed since

  // These belong to one call and are members only to reuse their memory.
  std::vector<IntegerCandidate> candidates_;
  std::vector<std::size_t> differenced_;  // candidates with a reference
  std::vector<LinearRow> differences_;    // two of each of these, beyond those of the reference
  Lambda lambda_;
  Differences real_;      // according to the filter's state
  Differences measured_;  // and to what codes and phases alone say of the wide lanes
  Differences given_;     // according to the state given the integers
  Lambda::Vector integers_;
  FilterState fixed_;
  Eigen::VectorXd dx_;
};

}  // namespace maploop::ppp
