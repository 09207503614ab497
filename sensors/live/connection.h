// Bytes from a sensor, over whatever it is connected with.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "msgs/time.h"
#include "sensors/live/endpoint.h"

namespace maploop::sensors {

struct ConnectionState {
  bool open = false;
  std::uint64_t opened = 0;  // times
  std::uint64_t bytes = 0;
  std::uint64_t too_large = 0;  // datagrams, left out
  std::string problem;          // why it is not open; empty while it is
};

// Where a sensor's bytes come from. One thread at a time.
class ByteStream {
 public:
  virtual ~ByteStream() = default;
  // What has come. Waits at most `patience` for it; 0: nothing. What is read after a reconnection
  // does not go on from what was read before it: see state().opened.
  virtual std::size_t read(std::span<std::uint8_t> to, Duration patience) = 0;
  virtual const ConnectionState& state() const = 0;
  virtual const std::string& name() const = 0;  // as it was given, without what is secret
};

// One that can be answered to.
class TwoWayStream : public ByteStream {
 public:
  // False where the system does not take all of it at once, or it is not open.
  virtual bool write(std::string_view text) = 0;
};

// Opens by itself, and again where the sensor was unplugged or its host went away, one attempt
// every half second; missing it is no error. Never blocks for longer than it is told to. One thread
// at a time.
class Connection final : public TwoWayStream {
 public:
  explicit Connection(Endpoint endpoint) : endpoint_(std::move(endpoint)) {}
  ~Connection() override { close(); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  // One datagram, or bytes of the stream.
  std::size_t read(std::span<std::uint8_t> to, Duration patience) override;
  // Over tcp alone.
  bool write(std::string_view text) override;

  const Endpoint& endpoint() const { return endpoint_; }
  const ConnectionState& state() const override { return state_; }
  const std::string& name() const override { return endpoint_.text; }
  // The one that a udp endpoint listens on; 0 while it is not open.
  std::uint16_t port() const;

 private:
  bool wait_open(MonotonicTime deadline);
  void open();
  int open_socket(std::string& problem);
  bool finish_connecting(MonotonicTime deadline);
  std::size_t receive(std::span<std::uint8_t> to);
  void fail(std::string problem);
  void close();

  Endpoint endpoint_;
  ConnectionState state_;
  int fd_ = -1;
  bool connecting_ = false;
  MonotonicTime next_attempt_{};
  MonotonicTime give_up_{};
};

}  // namespace maploop::sensors
