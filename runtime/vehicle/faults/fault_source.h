// Defines a source with a fault: it takes the samples of another source and corrupts some of them.
//
// Which samples are struck depends only on the fault and on the samples, so that every run of a
// replay has the same fault. `available` strictly increases as sensors::Source promises; the stamps
// do not if that is the fault.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "runtime/vehicle/faults/fault.h"
#include "runtime/vehicle/faults/fault_corruption.h"
#include "runtime/vehicle/faults/image_faults.h"
#include "runtime/vehicle/faults/scan_faults.h"
#include "sensors/source.h"

namespace maploop::vehicle {

// A fault of one run; `struck` counts the samples, the items of a stage or the threads.
struct ActiveFault {
  Fault fault;
  FaultWindow window;
  double focal_length = 0.0;  // px, of the cameras
  std::atomic<std::uint64_t> struck{0};
};

template <class T>
class FaultySource final : public sensors::Source<T> {
 public:
  // `active` must outlive the source.
  FaultySource(std::unique_ptr<sensors::Source<T>> source, ActiveFault& active)
      : source_(std::move(source)), active_(active) {}

  bool next(T& sample) override {
    if (!produce(sample)) return false;
    sample.available = std::max(sample.available, last_ + closest);
    last_ = sample.available;
    ++delivered_;
    return true;
  }

  const sensors::SourceReport& report() const override {
    report_ = source_->report();
    report_.delivered = delivered_;
    report_.refused += lost_.refused;
    report_.refusals.insert(report_.refusals.end(), lost_.refusals.begin(), lost_.refusals.end());
    return report_;
  }

 private:
  // Two samples that fall due together are delivered this far apart: it is the resolution of a
  // log's clock.
  static constexpr Duration closest = std::chrono::microseconds(1);

  const Fault& fault() const { return active_.fault; }

  // Reads the next sample to deliver; next() corrects an `available` that is too early.
  bool produce(T& sample) {
    if (std::exchange(holds_, false)) {
      std::swap(sample, held_);
      return true;
    }
    while (source_->next(sample)) {
      if (!strikes(sample)) return true;
      switch (fault().kind) {
        case FaultKind::lost:
          lost_.refuse({fault().text, 0, "lost the sample of " + format_time(sample.stamp)});
          continue;
        case FaultKind::duplicated:
          held_ = sample;
          held_.available += from_seconds(fault().by);
          holds_ = true;
          return true;
        case FaultKind::reordered:
          // The successor is never struck itself. The last sample has none and keeps its place.
          std::swap(sample, held_);
          holds_ = source_->next(sample);
          if (!holds_) std::swap(sample, held_);
          return true;
        default:
          alter(sample);
          return true;
      }
    }
    return false;
  }

  // Returns whether the fault strikes this sample, and counts it. Must be called once for each
  // sample.
  bool strikes(const T& sample) {
    // The kind changes the seed, so that faults of different kinds with the same seed are
    // independent.
    const std::uint64_t seed = fault().seed * 32 + static_cast<std::uint64_t>(fault().kind);
    if (!active_.window.contains(sample.available) || !drawn(fault().share, seed, sample.stamp)) {
      return false;
    }
    active_.struck.fetch_add(1, std::memory_order_relaxed);
    return true;
  }

  // For the kinds that only change samples.
  void alter(T& sample) {
    if (!begun_) begun_ = sample.available;
    const double elapsed = to_seconds(sample.available - *begun_);
    switch (fault().kind) {
      case FaultKind::late:
        sample.available += from_seconds(fault().by);
        return;
      case FaultKind::jump:
        return shift_stamps(sample, from_seconds(fault().by));
      case FaultKind::skewed:
        return shift_stamps(sample, from_seconds(1e-6 * fault().by * elapsed));
      case FaultKind::frozen:
        if (!first_) first_ = sample;
        return repeat(sample, *first_);
      default:
        distort(sample, {fault().kind, fault().target, fault().by, elapsed, fault().seed,
                         active_.focal_length});
    }
  }

  std::unique_ptr<sensors::Source<T>> source_;
  ActiveFault& active_;
  T held_{};  // is delivered next, if holds_
  bool holds_ = false;
  std::optional<T> first_;     // the first one struck by `frozen`
  std::optional<Time> begun_;  // when the first altered one was available
  Time last_ = Time::min();
  std::uint64_t delivered_ = 0;
  sensors::SourceReport lost_;
  mutable sensors::SourceReport report_;  // filled by report()
};

}  // namespace maploop::vehicle
