#include "ppp/readers/streams/pvt_stream.h"

#include "ppp/readers/streams/epoch_order.h"

namespace maploop::ppp {

void PvtStream::push(std::span<const std::uint8_t> bytes) {
  bytes_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

bool PvtStream::next(UbxPvt& pvt) {
  UbxFrames frames(bytes_, true);
  bool found = false;
  for (UbxFrame frame; !found && frames.next(frame);) {
    ++counts_.frames;
    problem_.clear();
    found = decode_pvt(frame, pvt, problem_) && is_later(pvt.time);
    counts_.unusable += problem_.empty() ? 0 : 1;
  }
  counts_.damaged += frames.damaged();
  bytes_.erase(0, frames.consumed());
  return found;
}

bool PvtStream::is_later(GpsTime epoch) {
  if (last_ && is_repeated(epoch, *last_)) {
    ++counts_.repeated;
    return false;
  }
  last_ = epoch;
  return true;
}

}  // namespace maploop::ppp
