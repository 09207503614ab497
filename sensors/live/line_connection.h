// This file reads lines of text that a sensor sends over UDP, TCP or a serial line.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

#include "sensors/clock/host_clock.h"
#include "sensors/live/connection.h"
#include "sensors/live/line_splitter.h"

namespace maploop::sensors {

// One thread at a time may use it.
class LineConnection {
 public:
  LineConnection(Endpoint endpoint, const HostClock& clock)
      : clock_(clock), connection_(std::move(endpoint)) {}

  // Passes each line and its arrival to take(line, arrival) until that returns true or about
  // `patience` has passed; returns whether it did. An incomplete line from before a reconnection is
  // dropped.
  template <class Take>
  bool wait(Duration patience, Take&& take) {
    const Time end = clock_.now() + patience;
    do {
      if (unread_.empty()) {
        const std::uint64_t opened = connection_.state().opened;
        const std::size_t size = connection_.read(buffer_, end - clock_.now());
        if (connection_.state().opened != opened) lines_.restart();
        if (size == 0) return false;
        unread_ = std::span(buffer_).first(size);
        arrival_ = clock_.now();
      }
      for (std::string_view line; lines_.next(unread_, line);) {
        if (take(line, arrival_)) return true;
      }
    } while (clock_.now() < end);
    return false;
  }

  const Endpoint& endpoint() const { return connection_.endpoint(); }
  const ConnectionState& state() const { return connection_.state(); }
  std::uint64_t dropped() const { return lines_.dropped(); }  // lines that were too long

 private:
  const HostClock& clock_;
  Connection connection_;
  LineSplitter lines_;
  std::array<std::uint8_t, 1024> buffer_{};
  std::span<const std::uint8_t> unread_;
  Time arrival_{};
};

}  // namespace maploop::sensors
