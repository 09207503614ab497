// Receives the messages of an LCM bus with their senders.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace maploop::dashboard {

// LCM's library does not tell who sent a message, but each program sends from a port of its own.
// This reads the same packets (LCM's UDP multicast protocol: whole messages "LC02", and parts of
// large ones "LC03"). An object belongs to one thread.
class SenderListener {
 public:
  // `sender` is the address that the message came from, such as "127.0.0.1:40512".
  using Handler = std::function<void(std::string_view sender, std::string_view channel,
                                     std::span<const std::uint8_t> data)>;

  // Returns whether a URL names a bus whose senders can be told apart.
  static bool understands(std::string_view url);

  // Throws std::runtime_error that names the URL if it cannot listen there. Precondition:
  // understands(url).
  SenderListener(std::string_view url, Handler handler);
  ~SenderListener();
  SenderListener(const SenderListener&) = delete;
  SenderListener& operator=(const SenderListener&) = delete;

  // Waits up to `milliseconds` for a message, and passes on what has come.
  void listen(int milliseconds);

 private:
  // A large message of one sender, of which parts are missing.
  struct Partial {
    std::uint32_t number = 0;
    unsigned missing = 0;
    std::string channel;
    std::vector<std::uint8_t> data;
  };

  void take(const std::string& sender, std::span<const std::uint8_t> packet);
  void take_part(const std::string& sender, std::span<const std::uint8_t> packet);
  void pass_on(std::string_view sender, std::string_view channel,
               std::span<const std::uint8_t> data);

  int socket_ = -1;
  Handler handler_;
  std::map<std::string, Partial> partial_;  // by sender
};

}  // namespace maploop::dashboard
