// Cuts a recording off at a given time.
#pragma once

#include <memory>
#include <utility>

#include "runtime/vehicle/graph/vehicle.h"
#include "sensors/source.h"

namespace maploop::vehicle {

// A LimitedSource ends with the last sample that is available by `end`.
template <class T>
class LimitedSource final : public sensors::Source<T> {
 public:
  LimitedSource(std::unique_ptr<sensors::Source<T>> source, Time end)
      : source_(std::move(source)), end_(end) {}

  bool next(T& sample) override { return source_->next(sample) && sample.available <= end_; }
  const sensors::SourceReport& report() const override { return source_->report(); }

 private:
  std::unique_ptr<sensors::Source<T>> source_;
  Time end_;
};

inline void limit(Sensors& sensors, Time end) {
  sensors.each_source([end]<class T>(std::unique_ptr<sensors::Source<T>>& source) {
    source = std::make_unique<LimitedSource<T>>(std::move(source), end);
  });
}

}  // namespace maploop::vehicle
