// Runs the map-aided filter together with map-free copies that can replace it. A wrong road that
// passes every gate then cannot pull the vehicle away permanently.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "estimators/fusion/guard_parameters.h"
#include "estimators/fusion/reduced_imu_filter.h"
#include "msgs/map_feedback.h"

namespace maploop::fusion {

// The aided estimate is the efficient estimator and a copy without the map is the consistent one,
// so the covariance of their difference is the difference of their covariances (Hausman,
// "Specification tests in econometrics", Econometrica 46, 1978). A larger difference shows that the
// map was wrong.
//
// Not thread-safe. Allocates nothing after the first feedback.
class GuardedFilter {
 public:
  // `filter` must not have received any map feedback.
  GuardedFilter(ReducedImuFilter filter, const GuardParameters& parameters = {})
      : aided_(std::move(filter)), parameters_(parameters) {}

  template <class Measurement>
  Outcome add(const Measurement& measurement) {
    for (Copy& copy : copies_)
      if (copy.filter) copy.filter->add(measurement);
    const PlaceUse before = aided_.place();
    const Outcome outcome = aided_.add(measurement);
    if (aided_.place() != before && aided_.place() == PlaceUse::moved) follow(measurement.stamp);
    return outcome;
  }
  // Passes the feedback to the aided filter only. The filters are compared at every feedback's
  // stamp, even if it feeds nothing back, and the older copy replaces the aided filter if the map
  // misled it.
  Outcome add(const MapFeedback& feedback);

  void recall(const RememberedCalibration& remembered) { aided_.recall(remembered); }
  void recall(const LastPlace& place) { aided_.recall(place); }
  Outcome start(const KnownStart& known) { return aided_.start(known); }
  const ReducedImuFilter& aided() const { return aided_; }
  FilterStatus status() const { return aided_.status(); }
  SelfCalibrations calibration() const { return aided_.calibration(); }

  // Returns the state of the older map-free copy at `t`; nothing before the first feedback, or if
  // its azimuth is lost.
  std::optional<FusedState> without_map_at(Time t) const;

  // These work as those of ReducedImuFilter. The copies exist from the first feedback on.
  std::size_t largest_archive(bool with_feedback) const {
    return (with_feedback ? 3 : 1) * aided_.largest_archive() + 256;
  }
  void archive(ArchiveWriter& ar) const;
  void archive(ArchiveReader& ar);

 private:
  struct Copy {
    std::optional<ReducedImuFilter> filter;
    Time born{};
    double way = 0.0;  // m, travelled since then
  };

  template <class Archive, class Filter>
  static void describe(Archive& ar, Filter& filter);
  bool lost(const NavState& state) const;
  void copy_to(Copy& copy, Time t);
  void follow(Time t);
  double distance_to(const Copy& copy, const NavState& aided, Time t) const;
  void restore(Time t);

  ReducedImuFilter aided_;
  GuardParameters parameters_;
  std::array<Copy, 2> copies_;  // the older one first
  Time last_{};                 // stamp of the last comparison
  bool apart_ = false;
  Time apart_since_{};
  Time paused_until_{};
};

}  // namespace maploop::fusion
