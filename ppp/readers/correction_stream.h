// A stream of RTCM 3 with corrections as it comes: ephemerides, and SSR of orbits, clocks and
// biases.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ppp/readers/navigation.h"
#include "ppp/readers/ssr.h"

namespace maploop::ppp {

struct CorrectionStreamCounts {
  std::uint64_t messages = 0;     // sound ones, also those that are passed over
  std::uint64_t ephemerides = 0;  // decoded
  std::uint64_t corrections = 0;  // messages decoded
  std::uint64_t unsupported = 0;  // of SSR: phase biases, ionosphere, other systems
  std::uint64_t damaged = 0;      // begins of frames with a wrong checksum, or cut
  std::uint64_t unusable = 0;     // messages that do not hold what they say
};

// Memory is that of one message and of what was pushed since; what is not taken is limited. One
// thread at a time.
class CorrectionStream {
 public:
  // Weeks, and days of GLONASS, are those nearest to `now`, which may be moved on.
  explicit CorrectionStream(GpsTime now) : now_(now) {}
  void set_now(GpsTime now) { now_ = now; }

  // Decodes what is whole. True where ephemerides or corrections were in it.
  bool push(std::span<const std::uint8_t> bytes);
  // What is pushed from now on does not go on from what was pushed: the connection was lost.
  void restart() { bytes_.clear(); }

  // Since they were last emptied.
  NavigationFile& navigation() { return navigation_; }
  std::vector<SsrUpdate>& updates() { return updates_; }
  const CorrectionStreamCounts& counts() const { return counts_; }

 private:
  void take(const Rtcm3Message& message);

  GpsTime now_;
  std::string bytes_;
  NavigationFile navigation_;
  std::vector<SsrUpdate> updates_;
  CorrectionStreamCounts counts_;
};

}  // namespace maploop::ppp
