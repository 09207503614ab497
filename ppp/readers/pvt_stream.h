// A u-blox receiver's own solutions as they come; other messages and text are passed over.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "ppp/readers/ubx_pvt.h"

namespace maploop::ppp {

struct PvtStreamCounts {
  std::uint64_t frames = 0;    // sound ones, of any kind
  std::uint64_t damaged = 0;   // begins of frames with a wrong checksum, or cut
  std::uint64_t unusable = 0;  // NAV-PVT that do not hold what they say
  std::uint64_t repeated = 0;  // epochs not later than the one before
};

// Memory is that of one frame and of what was pushed since. One thread at a time.
class PvtStream {
 public:
  // Then call next() until it is false.
  void push(std::span<const std::uint8_t> bytes);
  // The next epoch, with a fix or without.
  bool next(UbxPvt& pvt);
  // What is pushed from now on does not go on from what was pushed: the connection was lost.
  void restart() { bytes_.clear(); }

  const PvtStreamCounts& counts() const { return counts_; }

 private:
  bool is_later(GpsTime epoch);

  std::string bytes_;
  std::string problem_;
  std::optional<GpsTime> last_;
  PvtStreamCounts counts_;
};

}  // namespace maploop::ppp
