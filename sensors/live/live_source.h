// This file defines the interface of all drivers of live sensors.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/diagnostics.h"
#include "msgs/time.h"
#include "sensors/live/connection.h"

namespace maploop::sensors {

// This is the state of the sensor and the counts of its samples so far.
struct LiveReport {
  std::string endpoint;
  ConnectionState connection{};
  std::uint64_t delivered = 0;
  std::uint64_t refused = 0;           // packets and lines
  std::vector<std::string> reasons{};  // counts of refusals, losses, interruptions
  std::vector<std::string> notes{};    // what the sensor reports about itself
  SensorClock clock{};

  // These add "3 damaged" if the count is not 0: of refusals, of losses and interruptions, and of
  // what the sensor reports.
  void refuse(std::uint64_t count, std::string_view what) {
    refused += count;
    lose(count, what);
  }
  void lose(std::uint64_t count, std::string_view what) { add(reasons, count, what); }
  void note(std::uint64_t count, std::string_view what) { add(notes, count, what); }

 private:
  static void add(std::vector<std::string>& to, std::uint64_t count, std::string_view what) {
    if (count > 0) to.push_back(std::to_string(count).append(" ").append(what));
  }
};

// A live sensor may not be connected yet, or may be unplugged and come back: none of that is an
// error. `stamp` and `available` of the delivered samples strictly increase, on the host's clock;
// all members but `received` are set. One thread at a time.
template <class T>
class LiveSource {
 public:
  LiveSource() = default;
  virtual ~LiveSource() = default;
  LiveSource(const LiveSource&) = delete;
  LiveSource& operator=(const LiveSource&) = delete;

  // Waits about `patience` at most for the next sample, and fills it in place, reusing its buffers.
  virtual bool wait(T& sample, Duration patience) = 0;

  virtual LiveReport report() const = 0;

  // Samples that were thinned or left out because the computer was too slow; any thread.
  virtual std::uint64_t shed() const { return 0; }
};

}  // namespace maploop::sensors
