// Messages of an LCM bus, for commands that watch it and speak to it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace maploop::tools {

// One thread's own, but for publish().
class BusListener {
 public:
  using Handler = std::function<void(std::string_view channel, std::span<const std::uint8_t> data)>;

  // `channels`: a regular expression of whole names. Throws std::runtime_error naming the URL and
  // what to do when LCM cannot listen there.
  BusListener(const std::string& url, const std::string& channels, Handler handler);
  ~BusListener();

  // Waits up to `milliseconds` for a message, and hands over what has come.
  void listen(int milliseconds);

  // Sends an encoded message; on any thread. False when LCM does not take it.
  bool publish(const std::string& channel, std::span<const std::uint8_t> data);

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

}  // namespace maploop::tools
