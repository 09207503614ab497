// Decodes a u-blox receiver's own solutions as they arrive; other messages and text are skipped.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "ppp/readers/streams/ubx_pvt.h"

namespace maploop::ppp {

struct PvtStreamCounts {
  std::uint64_t frames = 0;    // with a right checksum, of any type
  std::uint64_t damaged = 0;   // frames that are cut or have a wrong checksum
  std::uint64_t unusable = 0;  // NAV-PVT with invalid content
  std::uint64_t repeated = 0;  // epochs not later than the previous one
};

// Memory is bounded by one frame and the bytes pushed. Only one thread may use a stream at a time.
class PvtStream {
 public:
  // After each push, call next() until it returns false.
  void push(std::span<const std::uint8_t> bytes);
  // Returns the next epoch, with or without a fix.
  bool next(UbxPvt& pvt);
  // Discards an incomplete frame after the connection was lost: new bytes do not continue the old
  // ones.
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
