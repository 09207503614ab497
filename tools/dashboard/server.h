// The dashboard's page, what it shows, and what it asks for, over HTTP.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "msgs/local_frame.h"
#include "tools/dashboard/live_channels.h"

namespace maploop::dashboard {

//   GET  /         the page
//   GET  /trail    where the vehicle has been
//   GET  /roads    ?latitude=RAD&longitude=RAD&height=M: roads about this origin, in its metres
//   GET  /events   server-sent events, each {"channel": ..., "message": ...}; at most ten looks a
//   second POST /control  {"run": ID, "kind": "pause", "value": 0}: a command to the player of a
//   replay
// A request is refused where its Host is neither localhost nor the address that is listened at (any
// numeric one for 0.0.0.0), and where it comes from another site's page.
class Server {
 public:
  static constexpr int most_browsers = 24;  // at /events; one more is refused (503)
  static constexpr std::chrono::seconds patience{
      5};  // one that reads nothing for longer is dropped

  struct Handlers {
    std::function<std::string()> trail;  // JSON; on any thread
    // Empty: done; otherwise why it is refused. On any thread.
    std::function<std::string(const std::string& run, const std::string& kind, double value)>
        control;
    std::function<std::string(const Geodetic& origin)> roads;  // JSON; on any thread
  };

  // Port 0: any that is free. Throws std::runtime_error naming address and port when they cannot be
  // listened at. `channels` must outlive it.
  Server(const std::string& address, int port, LiveChannels& channels, Handlers handlers);
  ~Server();  // ends all connections

  int port() const { return port_; }

 private:
  struct Http;
  std::unique_ptr<Http> http_;
  int port_ = 0;
};

}  // namespace maploop::dashboard
