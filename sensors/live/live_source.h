// The one interface of a driver of a live sensor.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "msgs/time.h"
#include "sensors/live/connection.h"

namespace maploop::sensors {

// What became of the sensor so far.
struct LiveReport {
  std::string endpoint;
  ConnectionState connection;
  std::uint64_t delivered = 0;
  std::uint64_t refused = 0;         // packets and lines
  std::vector<std::string> reasons;  // with their counts: of refusals, losses, interruptions
  std::vector<std::string> notes;    // what it says of itself and of its clock
};

// A sensor that may not be there yet, may be unplugged and come again: nothing of that is an error.
// `stamp` and `available` of what is delivered strictly increase, on the host's clock; all but
// `received` is set. For one thread at a time.
template <class T>
class LiveSource {
 public:
  LiveSource() = default;
  virtual ~LiveSource() = default;
  LiveSource(const LiveSource&) = delete;
  LiveSource& operator=(const LiveSource&) = delete;

  // Waits at most about `patience` for the next sample, and fills it in place, reusing its buffers.
  virtual bool wait(T& sample, Duration patience) = 0;

  virtual LiveReport report() const = 0;
};

// "3 damaged", where there are any.
inline void note_count(std::vector<std::string>& to, std::uint64_t count, const std::string& what) {
  if (count > 0) to.push_back(std::to_string(count) + ' ' + what);
}

}  // namespace maploop::sensors
