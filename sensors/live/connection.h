// This file reads the bytes that a sensor sends over UDP, TCP or a serial line.
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
  std::uint64_t opened = 0;  // how often it was opened
  std::uint64_t bytes = 0;
  std::uint64_t too_large = 0;  // datagrams that were dropped
  std::string problem;          // why it is not open; empty while it is open
};

// This is the interface to any origin of a sensor's bytes. One thread at a time.
class ByteStream {
 public:
  virtual ~ByteStream() = default;
  // Returns the number of bytes received, waiting at most `patience` for them; 0 if nothing came.
  // Bytes read after a reconnection do not continue those read before it: see state().opened.
  virtual std::size_t read(std::span<std::uint8_t> to, Duration patience) = 0;
  virtual const ConnectionState& state() const = 0;
  virtual const std::string& name() const = 0;  // as it was given, without secrets
};

// This is a stream that can also be written to.
class TwoWayStream : public ByteStream {
 public:
  // Returns false if the stream is not open, or the system does not accept all of `text` at once.
  virtual bool write(std::string_view text) = 0;
};

// Opens automatically, and again after the sensor was unplugged or its host went away, with one
// attempt every half second; a missing sensor is not an error. Never blocks for longer than
// `patience`. One thread at a time.
class Connection final : public TwoWayStream {
 public:
  explicit Connection(Endpoint endpoint) : endpoint_(std::move(endpoint)) {}
  ~Connection() override { close(); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  // Reads one datagram, or bytes of the stream.
  std::size_t read(std::span<std::uint8_t> to, Duration patience) override;
  // Works over tcp only.
  bool write(std::string_view text) override;

  const Endpoint& endpoint() const { return endpoint_; }
  const ConnectionState& state() const override { return state_; }
  const std::string& name() const override { return endpoint_.text; }
  // Returns the port that a udp endpoint listens on; 0 while it is not open.
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
