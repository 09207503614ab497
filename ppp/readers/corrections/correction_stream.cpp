#include "ppp/readers/corrections/correction_stream.h"

#include "ppp/readers/streams/rtcm3_ephemeris.h"

namespace maploop::ppp {

bool CorrectionStream::push(std::span<const std::uint8_t> bytes) {
  bytes_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::uint64_t before = counts_.ephemerides + counts_.corrections;
  Rtcm3Frames frames(bytes_, true);
  for (Rtcm3Message message; frames.next(message);) take(message);
  counts_.damaged += frames.damaged();
  bytes_.erase(0, frames.consumed());
  return counts_.ephemerides + counts_.corrections > before;
}

void CorrectionStream::take(const Rtcm3Message& message) {
  constexpr std::size_t most = 4096;
  ++counts_.messages;
  const int refused = navigation_.refused;
  if (add_ephemeris(message, now_, navigation_)) {
    navigation_.refused == refused ? ++counts_.ephemerides : ++counts_.unusable;
    navigation_.limit(most);
    return;
  }
  switch (decode_ssr(message, now_, updates_, ionosphere_)) {
    case SsrResult::none:
      break;
    case SsrResult::decoded:
      ++counts_.corrections;
      break;
    case SsrResult::incomplete:
      ++counts_.unusable;
      break;
    case SsrResult::unsupported:
      ++counts_.unsupported;
      break;
  }
  if (updates_.size() > most) updates_.clear();
}

}  // namespace maploop::ppp
