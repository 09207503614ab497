// Resolves ambiguities to integers, epoch by epoch, and conditions the filter's state on them. The
// filter itself keeps real-valued ambiguities, so that wrong integers end with their epoch.
#pragma once

#include <optional>
#include <vector>

#include "ppp/filter/epoch_rows.h"
#include "ppp/filter/filter_state.h"
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

  static constexpr std::size_t largest_archive = satellite_slots * 48 + 64;
  template <class Archive>
  void archive(Archive& ar) {
    ar(wide_lanes_, known_, unchanged_since_);
  }

 private:
  // The integer of a satellite in earlier epochs, apart from a number that its system shares.
  struct Known {
    bool known = false;
    double narrow = 0.0, wide = 0.0;  // cycles

    template <class Archive>
    void archive(Archive& ar) {
      ar(known, narrow, wide);
    }
  };
  void take(const FilterState& state, const std::vector<Tracked>& tracked,
            const std::vector<Row>& rows);
  void choose_references(const FilterState& state);
  const IntegerCandidate& reference_of(const IntegerCandidate& c) const;
  double difference(const FilterState& state, const IntegerCandidate& c) const;
  double covariance(const FilterState& state, const IntegerCandidate& a,
                    const IntegerCandidate& b) const;
  void fill_differences(const FilterState& state);
  int search(IntegerReport& report);
  void condition(const FilterState& state, int count);
  void find_own_integers();
  bool confirmed(GpsTime t);

  PppParameters parameters_;
  WideLanes wide_lanes_;
  std::vector<Known> known_;                // by Satellite::slot()
  std::optional<GpsTime> unchanged_since_;  // no integer has changed since

  // These belong to one call and are members only to reuse their memory.
  std::vector<IntegerCandidate> candidates_;
  std::vector<std::size_t> differenced_;  // candidates with a reference, in the order of `real_`
  Lambda lambda_;
  Lambda::Vector real_, integers_;
  Lambda::Matrix covariance_;
  FilterState fixed_;
  Eigen::VectorXd dx_;
};

}  // namespace maploop::ppp
