// A recording whose time does not leap.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "msgs/input_limits.h"
#include "runtime/vehicle/vehicle.h"
#include "sensors/source.h"

namespace maploop::vehicle {

// Leaves out, and reports, a sample that is more than input_limits::longest_gap after the one
// before it, unless the next one follows it as samples do (then the sensor has paused): the vehicle
// would compute all the time between. So one wrong stamp costs one sample.
template <class T>
class GapSource final : public sensors::Source<T> {
 public:
  explicit GapSource(std::unique_ptr<sensors::Source<T>> source) : source_(std::move(source)) {}

  bool next(T& sample) override {
    using input_limits::longest_gap, input_limits::longest_pause, input_limits::within;
    if (waits_) {  // the sample that followed one behind a pause
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

  // To be read after the end.
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
