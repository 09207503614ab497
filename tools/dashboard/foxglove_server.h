// Serves messages to Foxglove over a WebSocket.
//
// The protocol is foxglove.websocket.v1 (github.com/foxglove/ws-protocol, docs/spec.md): the server
// names its channels, a viewer subscribes to some, and only those are sent, as JSON.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace maploop::dashboard {

// All functions may be called on any thread. None of them waits for a viewer: a slow one loses its
// oldest messages, and one that reads nothing for `patience` is disconnected.
class FoxgloveServer {
 public:
  static constexpr int most_viewers = 24;
  static constexpr std::size_t most_waiting = std::size_t{8} << 20U;  // bytes for one viewer
  static constexpr std::chrono::seconds patience{5};

  struct Channel {
    std::string topic, schema_name, schema;  // the JSON schema's text
  };

  // The service /replay/control: {"run": ID, "kind": "pause", "value": 0}. Returns an empty text,
  // or the reason of the refusal. Called on the server's thread.
  using Control =
      std::function<std::string(const std::string& run, const std::string& kind, double value)>;

  // Port 0 selects any free port. A viewer that is a web page is refused unless its origin, such as
  // https://app.foxglove.dev, is in `origins`. Throws std::runtime_error naming address and port if
  // it cannot listen at them.
  FoxgloveServer(const std::string& address, int port, std::vector<std::string> origins,
                 Control control);
  ~FoxgloveServer();  // ends all connections

  int port() const;

  // Adds a channel, and returns its id.
  int add(Channel channel);

  // Returns whether a viewer is subscribed to a channel.
  bool wanted(int channel) const;

  // Sends a message to the subscribed viewers. `nanoseconds` is its time since 1970-01-01. If
  // `keep`, who subscribes later gets it as well, until a message of another time comes, or
  // forget() is called.
  void publish(int channel, std::int64_t nanoseconds, std::string json, bool keep = false);
  void forget(int channel);

  // Counts messages that viewers were too slow for.
  std::uint64_t lost() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace maploop::dashboard
