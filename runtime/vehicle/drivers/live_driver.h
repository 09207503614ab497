// A sensor driver on the road: releases each sample when it comes.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/core/latest_value.h"
#include "runtime/vehicle/drivers/driver.h"
#include "sensors/live/live_source.h"

namespace maploop::vehicle {

// While nothing comes it promises, every few milliseconds, that nothing has come: nobody waits for
// a sensor that is missing. A flood leaves the threads below it a fifth of its processor. What it
// says of itself it writes down when it was asked to, once a second, and only then takes memory.
template <class T>
class LiveDriver final : public Driver<T> {
 public:
  LiveDriver(const StageSpec& spec, std::unique_ptr<sensors::LiveSource<T>> source,
             Outputs<T> outputs)
      : Driver<T>(spec, std::move(outputs)), source_(std::move(source)) {}

  // Before the clock has started nothing is late.
  void run(runtime::DataClock& clock, const std::stop_token& stop) override {
    this->begin_steps();
    Time last = Time::min();
    write_report();
    while (!stop.stop_requested()) {
      // Whatever is read from now on is available later.
      const Time now = clock.now();
      if (source_->wait(sample_, patience)) {
        sample_.available = last = std::max(sample_.available, last + Duration(1));
        this->release(sample_, clock, stop);
      } else {
        last = std::max(last, now);
        std::this_thread::sleep_for(nap);
      }
      this->promise(last);
      if (asked_.exchange(false, std::memory_order_relaxed)) write_report();
    }
    write_report();
  }

  sensors::SourceReport report() const override {
    const sensors::LiveReport said = source_->report();
    sensors::SourceReport report;
    report.delivered = said.delivered;
    report.refused = said.refused;
    for (const std::string& reason : said.reasons) {
      report.refusals.push_back({said.endpoint, 0, reason});
    }
    return report;
  }

  std::optional<SensorHealth> health() override {
    if (const sensors::LiveReport* report = reports_.latest()) known_ = report;
    asked_.store(true, std::memory_order_relaxed);
    SensorHealth h;
    h.name = this->spec().name;
    if (known_ == nullptr) return h;
    h.endpoint = known_->endpoint;
    h.connected = known_->connection.open;
    h.connections = known_->connection.opened;
    h.delivered = known_->delivered;
    h.refused = known_->refused;
    h.problem = known_->connection.problem;
    h.clock = known_->clock;
    return h;
  }

  std::uint64_t shed() const override { return source_->shed(); }

 private:
  // Longest time without a look at the stop token, without a promise, and without a pause.
  static constexpr Duration patience = std::chrono::milliseconds(2);
  static constexpr Duration nap = std::chrono::microseconds(500);

  void write_report() {
    reports_.back() = source_->report();
    reports_.publish();
  }

  std::unique_ptr<sensors::LiveSource<T>> source_;
  T sample_{};
  std::atomic<bool> asked_{false};
  runtime::LatestValue<sensors::LiveReport> reports_;
  const sensors::LiveReport* known_ = nullptr;  // the reader's
};

}  // namespace maploop::vehicle
