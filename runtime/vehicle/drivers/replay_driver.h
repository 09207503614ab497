// A sensor driver of a recording: releases each sample when it falls due.
#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "runtime/vehicle/drivers/driver.h"
#include "sensors/source.h"

namespace maploop::vehicle {

template <class T>
class ReplayDriver final : public Driver<T> {
 public:
  ReplayDriver(const StageSpec& spec, std::unique_ptr<sensors::Source<T>> source,
               Outputs<T> outputs)
      : Driver<T>(spec, std::move(outputs)), source_(std::move(source)) {}

  std::optional<Time> load_first() override {
    more_ = source_->next(sample_);
    return more_ ? std::optional(sample_.available) : std::nullopt;
  }

  void skip_until(Time t) override {
    while (more_ && sample_.available <= t) more_ = source_->next(sample_);
  }

  void run(runtime::DataClock& clock, const std::stop_token& stop) override {
    this->begin_steps();
    Time last = Time::min();
    for (; more_; more_ = source_->next(sample_)) {
      if (sample_.available <= last) {
        throw std::logic_error("the source of '" + std::string(this->spec().name) +
                               "' broke its promise of increasing times at sample " +
                               std::to_string(sample_.sequence));
      }
      last = sample_.available;
      // Consumers need not wait for a sample that is still to come.
      this->promise(last - Duration(1));
      if (!clock.sleep_until(last, stop)) return;
      this->release(sample_, clock, stop);
      this->promise(last);
    }
  }

  sensors::SourceReport report() const override { return source_->report(); }

 private:
  std::unique_ptr<sensors::Source<T>> source_;
  T sample_{};
  bool more_ = false;
};

}  // namespace maploop::vehicle
