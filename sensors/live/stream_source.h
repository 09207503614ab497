// This file defines the base of all live sensors that send a stream of bytes, or datagrams.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "sensors/clock/host_clock.h"
#include "sensors/live/connection.h"
#include "sensors/live/live_source.h"

namespace maploop::sensors {

// Passes what arrives to the decoder of a derived class. `clock` must outlive the source.
template <class T>
class StreamSource : public LiveSource<T> {
 public:
  StreamSource(std::unique_ptr<ByteStream> stream, const HostClock& clock)
      : clock_(clock), stream_(std::move(stream)) {}

  bool wait(T& sample, Duration patience) override {
    const Time end = clock_.now() + patience;
    for (bool over = false;; over = clock_.now() >= end) {
      if (take(unread_, arrival_, sample)) {
        ++delivered_;
        return true;
      }
      if (over) return false;
      const std::uint64_t opened = stream_->state().opened;
      const std::size_t size = stream_->read(buffer_, end - clock_.now());
      if (stream_->state().opened != opened) restart();
      if (size == 0) return false;
      unread_ = std::span(buffer_).first(size);
      arrival_ = clock_.now();
    }
  }

  LiveReport report() const final {
    LiveReport report{stream_->name(), stream_->state(), delivered_};
    report.lose(stream_->state().too_large, "datagrams too large");
    describe(report);
    return report;
  }

 protected:
  // Takes bytes off the front until `sample` is complete (true), or until all are taken (false).
  // `bytes` may be empty, and a datagram comes whole. `arrival` is that of the bytes.
  virtual bool take(std::span<const std::uint8_t>& bytes, Time arrival, T& sample) = 0;
  // The connection was lost and opened again: the next bytes do not continue the earlier ones.
  virtual void restart() {}
  // Adds the counts of the decoder.
  virtual void describe(LiveReport& report) const = 0;

  // For take(): sets `stamp`, `available` and `sequence`. Both times strictly increase whatever the
  // clocks do; several samples may arrive at once.
  void deliver(Time stamp, Time arrival, T& sample) {
    sample.stamp = last_stamp_ = std::max(stamp, last_stamp_ + Duration(1));
    sample.available = last_available_ = std::max(arrival, last_available_ + Duration(1));
    sample.sequence = delivered_;
  }
  Time last_stamp() const { return last_stamp_; }
  std::uint64_t delivered() const { return delivered_; }
  const HostClock& clock() const { return clock_; }

 private:
  const HostClock& clock_;
  std::unique_ptr<ByteStream> stream_;
  std::array<std::uint8_t, 2048> buffer_{};
  std::span<const std::uint8_t> unread_;
  Time arrival_{};
  std::uint64_t delivered_ = 0;
  Time last_stamp_{}, last_available_{};
};

}  // namespace maploop::sensors
