#include "ppp/readers/streams/receiver_stream.h"

#include "ppp/readers/streams/epoch_order.h"
#include "ppp/readers/streams/rtcm3_ephemeris.h"

namespace maploop::ppp {
namespace {

// All satellites together send only few new messages between two epochs.
constexpr std::size_t max_messages = 512;

}  // namespace

void ReceiverStream::push(std::span<const std::uint8_t> bytes) {
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  ubx_.append(text, bytes.size());
  rtcm_.append(text, bytes.size());
}

void ReceiverStream::restart() {
  ubx_.clear();
  rtcm_.clear();
}

template <class Frames, class Frame>
bool ReceiverStream::scan(std::string& bytes, std::uint64_t& sound, std::uint64_t& damaged,
                          Epoch& epoch) {
  Frames frames(bytes, true);
  bool whole = false;
  for (Frame frame; !whole && frames.next(frame);) {
    ++sound;
    problem_.clear();
    whole = take(frame, epoch);
    counts_.unusable += problem_.empty() ? 0 : 1;
    navigation_.limit(max_messages);
  }
  damaged += frames.damaged();
  bytes.erase(0, frames.consumed());
  return whole;
}

// RTCM comes first: if a receiver sends both, its ephemerides are known before the next epoch.
bool ReceiverStream::next(Epoch& epoch) {
  return scan<Rtcm3Frames, Rtcm3Message>(rtcm_, counts_.rtcm, rtcm_damaged_, epoch) ||
         scan<UbxFrames, UbxFrame>(ubx_, counts_.ubx, ubx_damaged_, epoch);
}

bool ReceiverStream::take(const UbxFrame& frame, Epoch& epoch) {
  // Without a time, the week of the subframes is unknown.
  if (has_epoch_ && subframes_.add(frame, now_, navigation_)) return false;
  return rawx_.decode(frame, epoch, problem_) && is_later(epoch);
}

bool ReceiverStream::take(const Rtcm3Message& message, Epoch& epoch) {
  if (const auto week = has_week_ ? std::nullopt : week_of(message)) {
    has_week_ = true;
    if (std::chrono::abs(*week - now_) > std::chrono::hours(24 * 7)) {
      now_ = *week;
      dropped_before_ += msm_.dropped();
      msm_ = MsmDecoder(now_);
    }
  }
  if (add_ephemeris(message, now_, navigation_)) return false;
  return msm_.decode(message, epoch, problem_) && is_later(epoch);
}

bool ReceiverStream::is_later(const Epoch& epoch) {
  if (has_epoch_ && is_repeated(epoch.time, now_)) {
    ++counts_.repeated;
    return false;
  }
  now_ = epoch.time;
  has_epoch_ = true;
  return true;
}

// Each frame finder sees false starts inside the other protocol's frames; they do not count as
// damage.
ReceiverStreamCounts ReceiverStream::counts() const {
  ReceiverStreamCounts c = counts_;
  c.unusable += static_cast<std::uint64_t>(navigation_.refused);
  c.dropped = static_cast<std::uint64_t>(rawx_.dropped() + dropped_before_ + msm_.dropped());
  if (c.ubx > 0 || c.rtcm == 0) c.damaged += ubx_damaged_;
  if (c.rtcm > 0) c.damaged += rtcm_damaged_;
  return c;
}

}  // namespace maploop::ppp
