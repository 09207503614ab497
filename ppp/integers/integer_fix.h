// Resolves ambiguities to integers, epoch by epoch, and conditions the filter's state on them. The
// filter itself keeps real-valued ambiguities, so that wrong integers end with their epoch.
#pragma once

#include <optional>
#include <vector>

#include "ppp/filter/epoch_rows.h"
#include "ppp/filter/filter_state.h"
#include "ppp/integers/ambiguity_differences.h"
#include "ppp/integers/fixed_combinations.h"
#include "ppp/integers/lambda.h"
#include "ppp/integers/wide_lanes.h"

namespace maploop::ppp {

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
      satellite_slots * sizeof(WideLanes::Mean) + FixedCombinations::largest_archive + 64;
  template <class Archive>
  void archive(Archive& ar) {
    ar(wide_lanes_, last_, unchanged_since_);
  }

 private:
  void take(const FilterState& state, const std::vector<Tracked>& tracked,
            const std::vector<Row>& rows);
  void use_wide_lanes();
  bool search(IntegerReport& report);
  void condition(const FilterState& state);

  PppParameters parameters_;
  WideLanes wide_lanes_;
  FixedCombinations last_;
  std::optional<GpsTime> unchanged_since_;  // no integer has changed since

  // These belong to one call and are members only to reuse their memory.
  AmbiguityDifferences differences_;
  Lambda lambda_;
  DifferenceValues real_;      // according to the filter's state
  DifferenceValues measured_;  // and to what codes and phases alone say of the wide lanes
  DifferenceValues given_;     // according to the state given the integers
  Lambda::Vector integers_;    // of the last decorrelated ambiguities
  FilterState fixed_;
  Eigen::VectorXd dx_;
};

}  // namespace maploop::ppp
