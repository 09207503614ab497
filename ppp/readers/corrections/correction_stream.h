// Decodes a stream of RTCM 3 corrections as it arrives: ephemerides, and SSR of orbits, clocks,
// biases and the ionosphere.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ppp/readers/corrections/ssr.h"
#include "ppp/readers/files/navigation.h"

namespace maploop::ppp {

struct CorrectionStreamCounts {
  std::uint64_t messages = 0;     // with a right checksum, of any type
  std::uint64_t ephemerides = 0;  // decoded
  std::uint64_t corrections = 0;  // messages that were decoded
  std::uint64_t unsupported = 0;  // SSR of other systems
  std::uint64_t damaged = 0;      // frames that are cut or have a wrong checksum
  std::uint64_t unusable = 0;     // messages with invalid content
};

// Memory is bounded by one message and the bytes of one push, and lists that are not emptied are
// limited. Only one thread may use a stream at a time.
class CorrectionStream {
 public:
  // Weeks, and GLONASS's days, are resolved to those nearest to `now`, which set_now() updates.
  explicit CorrectionStream(GpsTime now) : now_(now) {}
  void set_now(GpsTime now) { now_ = now; }

  // Decodes all complete messages. Returns true if they contained ephemerides or corrections.
  bool push(std::span<const std::uint8_t> bytes);
  // Discards an incomplete message after the connection was lost: new bytes do not continue the old
  // ones.
  void restart() { bytes_.clear(); }

  // These hold what was decoded since the caller last emptied them.
  NavigationFile& navigation() { return navigation_; }
  std::vector<SsrUpdate>& updates() { return updates_; }
  std::optional<SsrIonosphere>& ionosphere() { return ionosphere_; }
  const CorrectionStreamCounts& counts() const { return counts_; }

 private:
  void take(const Rtcm3Message& message);

  GpsTime now_;
  std::string bytes_;
  NavigationFile navigation_;
  std::vector<SsrUpdate> updates_;
  std::optional<SsrIonosphere> ionosphere_;
  CorrectionStreamCounts counts_;
};

}  // namespace maploop::ppp
