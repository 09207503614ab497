// Decodes what a receiver sends as it arrives: UBX (RAWX, SFRBX) or RTCM 3 (MSM4 to MSM7,
// ephemerides), recognized by content.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "ppp/observations.h"
#include "ppp/readers/files/navigation.h"
#include "ppp/readers/streams/rtcm3.h"
#include "ppp/readers/streams/ubx.h"
#include "ppp/readers/streams/ubx_subframes.h"

namespace maploop::ppp {

struct ReceiverStreamCounts {
  std::uint64_t ubx = 0, rtcm = 0;  // frames with a right checksum
  std::uint64_t damaged = 0;        // frames that are cut or have a wrong checksum
  std::uint64_t unusable = 0;       // messages with invalid content
  std::uint64_t repeated = 0;       // epochs not later than the previous one
  std::uint64_t dropped = 0;        // values of unnamed signals, or that cannot be right
};

// Uses the same decoders as the readers of files (rtcm3.h, ubx.h). Memory is bounded by one frame
// and the bytes pushed, and messages not taken from navigation() are limited. Only one thread may
// use a stream at a time.
class ReceiverStream {
 public:
  // RTCM's observations do not contain their week: it is that of `now`, until an ephemeris of GPS
  // or Galileo gives another.
  explicit ReceiverStream(GpsTime now) : now_(now), msm_(now) {}

  // After each push, call next() until it returns false.
  void push(std::span<const std::uint8_t> bytes);
  // Returns the next complete epoch.
  bool next(Epoch& epoch);
  // Discards incomplete frames after the connection was lost: new bytes do not continue the old
  // ones.
  void restart();

  // Returns the ephemerides since the caller last emptied it.
  NavigationFile& navigation() { return navigation_; }
  ReceiverStreamCounts counts() const;

 private:
  bool take(const UbxFrame& frame, Epoch& epoch);
  bool take(const Rtcm3Message& message, Epoch& epoch);
  bool is_later(const Epoch& epoch);
  template <class Frames, class Frame>
  bool scan(std::string& bytes, std::uint64_t& sound, std::uint64_t& damaged, Epoch& epoch);

  GpsTime now_;  // time of the last epoch
  bool has_epoch_ = false;
  bool has_week_ = false;
  // The bytes may contain either protocol and other text: each frame finder has its own copy.
  std::string ubx_, rtcm_;
  RawxDecoder rawx_;
  SubframeCollector subframes_;
  MsmDecoder msm_;
  NavigationFile navigation_;
  std::string problem_;
  ReceiverStreamCounts counts_;
  std::uint64_t ubx_damaged_ = 0, rtcm_damaged_ = 0;
  int dropped_before_ = 0;  // by an earlier msm_
};

}  // namespace maploop::ppp
