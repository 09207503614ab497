// What a receiver sends as it comes: UBX (RAWX, SFRBX) or RTCM 3 (MSM4 to MSM7, ephemerides), told
// apart by content.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "ppp/observations.h"
#include "ppp/readers/navigation.h"
#include "ppp/readers/rtcm3.h"
#include "ppp/readers/ubx.h"
#include "ppp/readers/ubx_subframes.h"

namespace maploop::ppp {

struct ReceiverStreamCounts {
  std::uint64_t ubx = 0, rtcm = 0;  // sound frames
  std::uint64_t damaged = 0;        // begins of frames with a wrong checksum, or cut
  std::uint64_t unusable = 0;       // messages that do not hold what they say
  std::uint64_t repeated = 0;       // epochs not later than the one before
  std::uint64_t left_out = 0;       // values without a name, or that no satellite gives
};

// Decodes by what the readers of files decode by (rtcm3.h, ubx.h). Memory is that of one frame and
// of what was pushed since; what is not taken of navigation() is limited. One thread at a time.
class ReceiverStream {
 public:
  // RTCM's observations do not say their week: it is that of `now`, until an ephemeris of GPS or
  // Galileo says another.
  explicit ReceiverStream(GpsTime now) : now_(now), msm_(now) {}

  // Then call next() until it is false.
  void push(std::span<const std::uint8_t> bytes);
  // The next whole epoch.
  bool next(Epoch& epoch);
  // What is pushed from now on does not go on from what was pushed: the connection was lost.
  void restart();

  // Ephemerides since it was last emptied.
  NavigationFile& navigation() { return navigation_; }
  ReceiverStreamCounts counts() const;

 private:
  bool take(const UbxFrame& frame, Epoch& epoch);
  bool take(const Rtcm3Message& message, Epoch& epoch);
  bool is_later(const Epoch& epoch);
  template <class Frames, class Frame>
  bool scan(std::string& bytes, std::uint64_t& sound, std::uint64_t& damaged, Epoch& epoch);

  GpsTime now_;  // of the last epoch
  bool has_epoch_ = false;
  bool has_week_ = false;
  // Either may be in it, and other text besides: each looks for its own frames.
  std::string ubx_, rtcm_;
  RawxDecoder rawx_;
  SubframeCollector subframes_;
  MsmDecoder msm_;
  NavigationFile navigation_;
  std::string problem_;
  ReceiverStreamCounts counts_;
  std::uint64_t ubx_damaged_ = 0, rtcm_damaged_ = 0;
  int left_out_before_ = 0;  // of an earlier msm_
};

}  // namespace maploop::ppp
