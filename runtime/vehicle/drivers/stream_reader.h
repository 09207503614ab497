// Passes a live stream of bytes to a decoder.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "sensors/clock/host_clock.h"
#include "sensors/live/connection.h"

namespace maploop::vehicle {

// A StreamReader is for one thread at a time. `clock` must outlive it.
class StreamReader {
 public:
  StreamReader(std::unique_ptr<sensors::ByteStream> stream, const sensors::HostClock& clock)
      : stream_(std::move(stream)), clock_(clock) {}

  // Pushes the bytes that arrive to the decoder until next() is true or about `patience` is over;
  // returns which. Calls restart() of the decoder if the connection was lost and opened again.
  // Bytes that arrived earlier are decoded first.
  template <class Decoder, class Next>
  bool wait(Duration patience, Decoder& decoder, Next&& next) {
    const Time end = clock_.now() + patience;
    do {
      if (next()) return true;
      const std::uint64_t opened = stream_->state().opened;
      const std::size_t size = stream_->read(buffer_, end - clock_.now());
      if (stream_->state().opened != opened) decoder.restart();
      if (size == 0) return false;
      arrival_ = clock_.now();
      decoder.push(std::span(buffer_).first(size));
    } while (clock_.now() < end);
    return false;
  }

  const sensors::ByteStream& stream() const { return *stream_; }
  Time arrival() const { return arrival_; }  // when the bytes pushed last arrived

 private:
  std::unique_ptr<sensors::ByteStream> stream_;
  const sensors::HostClock& clock_;
  std::array<std::uint8_t, 2048> buffer_{};
  Time arrival_{};
};

}  // namespace maploop::vehicle
