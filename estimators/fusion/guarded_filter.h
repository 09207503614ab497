// The map-aided filter beside map-free copies of itself, which can take its place: a wrong road
// that passes every gate must not drag the vehicle away.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "estimators/fusion/guard_parameters.h"
#include "estimators/fusion/reduced_imu_filter.h"
#include "msgs/map_feedback.h"

namespace maploop::fusion {

// The aided estimate is the efficient one, a copy without the map the consistent one: their
// difference has the difference of their covariances (Hausman, "Specification tests in
// econometrics", Econometrica 46, 1978). Where it is larger, the map was wrong.
//
// Not thread-safe. Allocates nothing after the first feedback.
class GuardedFilter {
 public:
  // A filter is one that nothing is fed back to.
  GuardedFilter(ReducedImuFilter filter, const GuardParameters& parameters = {})
      : aided_(std::move(filter)), parameters_(parameters) {}

  template <class Measurement>
  Outcome add(const Measurement& measurement) {
    for (Copy& copy : copies_)
      if (copy.filter) copy.filter->add(measurement);
    return aided_.add(measurement);
  }
  // To the aided filter alone; compares at the feedback's stamp, also where it feeds nothing back,
  // and restores the aided filter where it has been led astray.
  Outcome add(const MapFeedback& feedback);

  Outcome start(const KnownStart& known) { return aided_.start(known); }
  const ReducedImuFilter& aided() const { return aided_; }
  FilterStatus status() const { return aided_.status(); }

  // As ReducedImuFilter's.
  std::size_t largest_archive() const { return 3 * aided_.largest_archive() + 256; }
  void archive(ArchiveWriter& ar) const;
  void archive(ArchiveReader& ar);

 private:
  struct Copy {
    std::optional<ReducedImuFilter> filter;
    Time born{};
    double way = 0.0;  // m since then
  };

  template <class Archive, class Filter>
  static void describe(Archive& ar, Filter& filter);
  bool lost(const NavState& state) const;
  void copy_to(Copy& copy, Time t);
  double distance_to(const Copy& copy, const NavState& aided, Time t) const;
  void restore(Time t);

  ReducedImuFilter aided_;
  GuardParameters parameters_;
  std::array<Copy, 2> copies_;  // the older one first
  Time last_{};                 // compared
  bool apart_ = false;
  Time apart_since_{};
  Time paused_until_{};
};

}  // namespace maploop::fusion
