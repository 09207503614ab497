// Defines sources with a fault: each takes the samples of another source and corrupts some of them.
//
// Which samples are struck depends only on the fault and on the samples, so that every run of a
// replay has the same fault. `available` strictly increases as sensors::Source promises; the stamps
// do not if that is the fault. A source with a fault is for one thread at a time, like any other.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "runtime/vehicle/faults/fault.h"
#include "runtime/vehicle/faults/fault_corruption.h"
#include "sensors/source.h"

namespace maploop::vehicle {

template <class T>
class FaultySource : public sensors::Source<T> {
 public:
  // `struck` counts the samples that the fault struck, and must outlive the source.
  FaultySource(std::unique_ptr<sensors::Source<T>> source, Fault fault, FaultWindow window,
               std::atomic<std::uint64_t>& struck)
      : source_(std::move(source)), fault_(std::move(fault)), window_(window), struck_(struck) {}

  bool next(T& sample) final {
    if (!produce(sample)) return false;
    sample.available = std::max(sample.available, last_ + closest);
    last_ = sample.available;
    ++delivered_;
    return true;
  }

  const sensors::SourceReport& report() const final {
    report_ = source_->report();
    report_.delivered = delivered_;
    report_.refused += lost_.refused;
    report_.refusals.insert(report_.refusals.end(), lost_.refusals.begin(), lost_.refusals.end());
    return report_;
  }

 protected:
  bool read(T& sample) { return source_->next(sample); }

  // Returns whether the fault strikes this sample, and counts it. Must be called once for each
  // sample.
  bool strikes(const T& sample) {
    // The kind changes the seed, so that faults of different kinds with the same seed are
    // independent.
    const std::uint64_t seed = fault_.seed * 16 + static_cast<std::uint64_t>(fault_.kind);
    if (!window_.contains(sample.available) || !drawn(fault_.share, seed, sample.stamp)) {
      return false;
    }
    struck_.fetch_add(1, std::memory_order_relaxed);
    return true;
  }

  const Fault& fault() const { return fault_; }
  void lose(const T& sample) {
    lost_.refuse({fault_.text, 0, "lost the sample of " + format_time(sample.stamp)});
  }

 private:
  // Reads the next sample to deliver; next() corrects an `available` that is too early.
  virtual bool produce(T& sample) = 0;

  // Two samples that fall due together are delivered this far apart: it is the resolution of a
  // log's clock.
  static constexpr Duration closest = std::chrono::microseconds(1);

  std::unique_ptr<sensors::Source<T>> source_;
  Fault fault_;
  FaultWindow window_;
  std::atomic<std::uint64_t>& struck_;
  Time last_ = Time::min();
  std::uint64_t delivered_ = 0;
  sensors::SourceReport lost_;
  mutable sensors::SourceReport report_;  // filled by report()
};

// An AlteringSource changes the samples that the fault strikes.
template <class T>
class AlteringSource final : public FaultySource<T> {
 public:
  AlteringSource(std::unique_ptr<sensors::Source<T>> source, Fault fault, FaultWindow window,
                 std::atomic<std::uint64_t>& struck, std::function<void(T&)> alter)
      : FaultySource<T>(std::move(source), std::move(fault), window, struck),
        alter_(std::move(alter)) {}

 private:
  bool produce(T& sample) override {
    if (!this->read(sample)) return false;
    if (this->strikes(sample)) alter_(sample);
    return true;
  }

  std::function<void(T&)> alter_;
};

template <class T>
class LosingSource final : public FaultySource<T> {
 public:
  using FaultySource<T>::FaultySource;

 private:
  bool produce(T& sample) override {
    while (this->read(sample)) {
      if (!this->strikes(sample)) return true;
      this->lose(sample);
    }
    return false;
  }
};

template <class T>
class DuplicatingSource final : public FaultySource<T> {
 public:
  using FaultySource<T>::FaultySource;

 private:
  bool produce(T& sample) override {
    if (again_) {
      again_ = false;
      std::swap(sample, copy_);
      return true;
    }
    if (!this->read(sample)) return false;
    if (this->strikes(sample)) {
      copy_ = sample;
      copy_.available += this->fault().by;
      again_ = true;
    }
    return true;
  }

  T copy_{};
  bool again_ = false;
};

// A ReorderingSource delivers a struck sample after its successor, which is never struck itself.
// The last sample has no successor and keeps its place.
template <class T>
class ReorderingSource final : public FaultySource<T> {
 public:
  using FaultySource<T>::FaultySource;

 private:
  bool produce(T& sample) override {
    if (held_) {
      held_ = false;
      std::swap(sample, overtaken_);
      return true;
    }
    if (!this->read(sample)) return false;
    if (!this->strikes(sample)) return true;
    std::swap(sample, overtaken_);
    if (this->read(sample)) {
      held_ = true;
    } else {
      std::swap(sample, overtaken_);
    }
    return true;
  }

  T overtaken_{};
  bool held_ = false;
};

}  // namespace maploop::vehicle
