// Serves the dashboard's page and its data over HTTP.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "msgs/local_frame.h"
#include "tools/dashboard/live_channels.h"

namespace maploop::dashboard {

//   GET  /         the page
//   GET  /trail    ?run=ID: the path of the vehicle so far
//   GET  /roads    ?latitude=RAD&longitude=RAD&height=M: roads around this origin, in its metres
//   GET  /events   ?run=ID: server-sent events of a run, each {"channel": ..., "message": ...}; at
//                  most ten updates a second
//   POST /control  {"run": ID, "kind": "pause", "value": 0}: a command to the player of a replay
// A request is refused if its Host is neither localhost nor the address that the server listens at
// (with 0.0.0.0: any numeric address), or if it comes from another site's page.
class Server {
 public:
  static constexpr int most_browsers = 24;            // at /events; further ones are refused (503)
  static constexpr std::chrono::seconds patience{5};  // longest time without reading

  struct Handlers {
    std::function<std::string(const std::string& run)> trail;  // JSON; on any thread
    // Returns an empty text if the command was sent, otherwise the reason of its refusal. Called on
    // any thread.
    std::function<std::string(const std::string& run, const std::string& kind, double value)>
        control;
    std::function<std::string(const Geodetic& origin)> roads;  // JSON; on any thread
  };

  // Port 0 selects any free port. Throws std::runtime_error naming address and port if it cannot
  // listen at them. `channels` must outlive it.
  Server(const std::string& address, int port, LiveChannels& channels, Handlers handlers);
  ~Server();  // ends all connections

  int port() const { return port_; }

 private:
  struct Http;
  std::unique_ptr<Http> http_;
  int port_ = 0;
};

}  // namespace maploop::dashboard
