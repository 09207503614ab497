// This file reads the stream of a mountpoint of an NTRIP caster.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "sensors/live/connection.h"
#include "sensors/live/ntrip_reply.h"
#include "sensors/live/ntrip_request.h"

namespace maploop::sensors {

// Sends its request automatically, and again after the caster refuses, ends the stream, or is
// silent for a minute: after one second, two, four, up to a minute. The host name is looked up each
// time. state().open is true while the caster sends the stream. A position of the address is sent
// with the request, and again `between_positions` after the last time.
class NtripClient final : public ByteStream {
 public:
  explicit NtripClient(NtripAddress address, Duration between_positions = std::chrono::seconds(10))
      : address_(std::move(address)), between_positions_(between_positions) {}

  std::size_t read(std::span<std::uint8_t> to, Duration patience) override;
  const ConnectionState& state() const override { return state_; }
  const std::string& name() const override { return address_.text; }

 private:
  bool find_host(Duration patience);
  void greet();
  void say_position();
  void give_up(std::string problem);

  struct Host {
    std::string address;  // numeric IPv4
    std::string problem;  // set if the address is missing
  };
  static std::future<Host> look_up(const std::string& name);

  NtripAddress address_;
  Duration between_positions_;
  ConnectionState state_;
  std::future<Host> lookup_;                  // valid while the answer is not known
  std::unique_ptr<TwoWayStream> connection_;  // nullptr while the address is not known
  std::uint64_t greeted_ = 0;                 // `opened` of the connection at the last request
  NtripReply reply_;
  std::array<std::uint8_t, 2048> buffer_{};
  std::span<const std::uint8_t> unread_;
  Duration pause_{};  // before the next attempt
  MonotonicTime next_lookup_{};
  MonotonicTime heard_{};  // when the stream last sent bytes, or the connection was opened
  MonotonicTime said_{};   // when the position was last sent
};

// Opens an endpoint (endpoint.h) or an NTRIP mountpoint. Throws std::invalid_argument if the text
// is neither.
std::unique_ptr<ByteStream> open_stream(std::string_view text);

}  // namespace maploop::sensors
