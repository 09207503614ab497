// Removes samples whose time is far from that of the sample before.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "msgs/input_limits.h"
#include "runtime/vehicle/graph/sensors.h"
#include "sensors/source.h"

namespace maploop::vehicle {

// A GapSource leaves out, and reports, a sample more than input_limits::longest_gap away from the
// one before it, because the vehicle would compute all the time between. It keeps the sample if the
// next one is within longest_gap of it and the gap is at most input_limits::longest_pause: then the
// sensor has paused. So one wrong stamp costs one sample.
template <class T>
class GapSource final : public sensors::Source<T> {
 public:
  explicit GapSource(std::unique_ptr<sensors::Source<T>> source) : source_(std::move(source)) {}

  bool next(T& sample) override {
    using input_limits::longest_gap, input_limits::longest_pause, input_limits::within;
    if (waits_) {  // `ahead_` confirmed that the sensor had paused
      waits_ = false;
      std::swap(sample, ahead_);
      last_ = sample.available;
      return true;
    }
    if (!source_->next(sample)) return false;
    while (last_ != Time::min() && !within(longest_gap, last_, sample.available)) {
      const bool more = source_->next(ahead_);
      if (more && within(longest_gap, sample.available, ahead_.available) &&
          within(longest_pause, last_, sample.available)) {
        waits_ = true;
        break;
      }
      leave_out(sample);
      if (!more) return false;
      std::swap(sample, ahead_);
    }
    last_ = sample.available;
    return true;
  }

  // The counts are complete only after the last sample.
  const sensors::SourceReport& report() const override {
    if (left_out_.refused == 0) return source_->report();
    all_ = source_->report();
    all_.delivered -= left_out_.refused;
    for (const sensors::Finding& finding : left_out_.refusals) all_.refuse(finding);
    all_.refused += left_out_.refused - left_out_.refusals.size();
    return all_;
  }

 private:
  void leave_out(const T& sample) {
    left_out_.refuse(
        {"sample " + std::to_string(sample.sequence), 0,
         format_time(sample.available) + " is more than an hour later than the sample before it"});
  }

  std::unique_ptr<sensors::Source<T>> source_;
  Time last_ = Time::min();
  T ahead_{};
  bool waits_ = false;
  sensors::SourceReport left_out_;
  mutable sensors::SourceReport all_;
};

inline void leave_out_leaps(Sensors& sensors) {
  sensors.each_source([]<class T>(std::unique_ptr<sensors::Source<T>>& source) {
    source = std::make_unique<GapSource<T>>(std::move(source));
  });
}

}  // namespace maploop::vehicle
