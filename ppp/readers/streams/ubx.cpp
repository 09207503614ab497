#include "ppp/readers/streams/ubx.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "ppp/readers/files/lines.h"
#include "ppp/readers/streams/epoch_builder.h"
#include "ppp/readers/streams/ubx_subframes.h"

namespace maploop::ppp {
namespace {

constexpr std::size_t head_size = 16, measurement_size = 32;

// The numbers are from the u-blox F9 HPG interface description, "GNSS identifiers" and "Signal
// identifiers"; the names are RINEX 3's.
struct NamedSignal {
  std::uint8_t gnss, signal;
  char band, attribute;
};
constexpr std::array named_signals{
    NamedSignal{0, 0, '1', 'C'}, NamedSignal{0, 3, '2', 'L'}, NamedSignal{0, 4, '2', 'S'},
    NamedSignal{0, 6, '5', 'I'}, NamedSignal{0, 7, '5', 'Q'}, NamedSignal{1, 0, '1', 'C'},
    NamedSignal{2, 0, '1', 'C'}, NamedSignal{2, 1, '1', 'B'}, NamedSignal{2, 3, '5', 'I'},
    NamedSignal{2, 4, '5', 'Q'}, NamedSignal{2, 5, '7', 'I'}, NamedSignal{2, 6, '7', 'Q'},
    NamedSignal{3, 0, '2', 'I'}, NamedSignal{3, 1, '2', 'I'}, NamedSignal{3, 2, '7', 'I'},
    NamedSignal{3, 3, '7', 'I'}, NamedSignal{3, 5, '1', 'P'}, NamedSignal{3, 6, '1', 'D'},
    NamedSignal{3, 7, '5', 'P'}, NamedSignal{3, 8, '5', 'D'}, NamedSignal{5, 0, '1', 'C'},
    NamedSignal{5, 1, '1', 'Z'}, NamedSignal{5, 4, '2', 'S'}, NamedSignal{5, 5, '2', 'L'},
    NamedSignal{5, 8, '5', 'I'}, NamedSignal{5, 9, '5', 'Q'}, NamedSignal{6, 0, '1', 'C'},
    NamedSignal{6, 2, '2', 'C'}, NamedSignal{7, 0, '5', 'A'}};

}  // namespace

std::optional<RawxDecoder::Key> RawxDecoder::key_of(std::string_view m) {
  const auto gnss = ubx_number<std::uint8_t>(m, 20);
  const auto signal = ubx_number<std::uint8_t>(m, 22);
  const auto satellite = ubx_satellite(gnss, ubx_number<std::uint8_t>(m, 21));
  const auto named =
      std::find_if(named_signals.begin(), named_signals.end(),
                   [&](const NamedSignal& n) { return n.gnss == gnss && n.signal == signal; });
  if (!satellite || named == named_signals.end()) return {};
  return Key{*satellite, named->band, named->attribute};
}

void RawxDecoder::add(const Key& key, std::string_view m, Epoch& epoch) {
  constexpr unsigned code_valid = 1, phase_valid = 2, half_known = 4, half_subtracted = 8;
  const unsigned status = ubx_number<std::uint8_t>(m, 30);
  const auto code = ubx_number<double>(m, 0), phase = ubx_number<double>(m, 8);
  const double doppler = ubx_number<float>(m, 16);
  const int lock_ms = ubx_number<std::uint16_t>(m, 24);
  const bool subtracted = (status & half_subtracted) != 0;
  // The phase has slipped if the time of lock is shorter than at the last epoch with this signal,
  // or shorter than the time since then.
  constexpr std::int64_t longest_ms = 64'500;
  Tracked& tracked = tracked_[key];
  const std::int64_t since_ms =
      tracked.seen ? (epoch.time - tracked.last) / std::chrono::milliseconds(1) : 0;
  const bool slipped = lock_ms == 0 || lock_ms < tracked.lock_ms ||
                       lock_ms < std::min(since_ms, longest_ms) ||
                       subtracted != tracked.half_subtracted;
  tracked = {true, epoch.time, lock_ms, subtracted};

  Signal signal{.band = key.band, .attribute = key.attribute};
  signal.cn0 = ubx_number<std::uint8_t>(m, 26);
  if (std::isfinite(doppler)) signal.doppler = doppler;
  if ((status & phase_valid) != 0 && std::isfinite(phase) && std::fabs(phase) < 1e9) {
    signal.phase = phase;
    signal.lost_lock = slipped;
    signal.half_cycle = (status & half_known) == 0;
  }
  if ((status & code_valid) != 0) {
    // As in files, no navigation satellite is nearer than 15000 km or farther than 80000 km.
    if (code > 1.0e7 && code < 1.0e8) {
      signal.code = code;
    } else {
      ++dropped_;
      return;
    }
  }
  if (signal.code == 0.0 && signal.phase == 0.0) return;
  epoch.signals.push_back(signal);
  ++epoch.satellites.back().count;
}

bool RawxDecoder::decode(const UbxFrame& frame, Epoch& epoch, std::string& problem) {
  constexpr int last_week = 10'000;  // in the year 2171
  problem.clear();
  if (frame.message_class != 0x02 || frame.id != 0x15) return false;
  const std::string_view payload = frame.payload;
  const std::size_t count = payload.size() < head_size ? 0 : ubx_number<std::uint8_t>(payload, 11);
  if (payload.size() != head_size + count * measurement_size) {
    problem = "the size of a RAWX message does not match its header";
    return false;
  }
  const auto tow = ubx_number<double>(payload, 0);
  const int week = ubx_number<std::uint16_t>(payload, 8);
  if (!(tow >= 0.0 && tow < 604800.0) || week == 0 || week > last_week) {
    problem = "a RAWX message has no valid time";
    return false;
  }
  epoch.clear();
  epoch.time = gps_week_time(week, tow);
  // A clock reset is no loss of lock: the receiver applies it to codes and phases alike.
  // The signals of a satellite are not next to each other.
  std::vector<std::pair<Key, std::string_view>> measurements;
  for (std::size_t i = 0; i < count; ++i) {
    const auto m = payload.substr(head_size + i * measurement_size, measurement_size);
    if (const auto key = key_of(m)) {
      measurements.emplace_back(*key, m);
    } else {
      ++dropped_;
    }
  }
  std::stable_sort(measurements.begin(), measurements.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const Key& key = measurements[i].first;
    if (i > 0 && key == measurements[i - 1].first) {
      ++dropped_;
      continue;
    }
    if (epoch.satellites.empty() || epoch.satellites.back().satellite != key.satellite) {
      if (!epoch.satellites.empty() && epoch.satellites.back().count == 0) {
        epoch.satellites.pop_back();
      }
      epoch.satellites.push_back(
          {key.satellite, static_cast<std::uint32_t>(epoch.signals.size()), 0});
    }
    add(key, measurements[i].second, epoch);
  }
  if (!epoch.satellites.empty() && epoch.satellites.back().count == 0) epoch.satellites.pop_back();
  if (epoch.satellites.empty()) {
    problem = "a RAWX message has no usable measurement";
    return false;
  }
  return true;
}

bool is_ubx(std::string_view bytes) {
  constexpr std::size_t far_enough = 65536;  // behind the text of a receiver's start
  UbxFrame frame;
  return UbxFrames(bytes.substr(0, far_enough)).next(frame);
}

Observations parse_ubx(std::string_view bytes, const std::string& file,
                       NavigationFile* navigation) {
  Observations result;
  result.file = file;
  RawxDecoder decoder;
  UbxFrames frames(bytes);
  std::string problem;
  Epoch epoch;
  SubframeCollector subframes;
  for (UbxFrame frame; frames.next(frame);) {
    // Without a time, the week of the subframes is unknown.
    if (navigation != nullptr && !result.epochs.empty() &&
        subframes.add(frame, result.epochs.back().time, *navigation))
      continue;
    if (!decoder.decode(frame, epoch, problem)) {
      if (!problem.empty()) refuse(result, frame.offset, problem);
    } else if (!result.epochs.empty() && epoch.time <= result.epochs.back().time) {
      refuse(result, frame.offset,
             "epoch " + format_gps_time(epoch.time) + " is not after the one before");
    } else {
      result.epochs.push_back(epoch);
    }
  }
  if (result.epochs.empty()) {
    throw ReadError(file + ": has no raw measurements; set the receiver to send UBX-RXM-RAWX");
  }
  result.header.first = result.epochs.front().time;
  result.header.last = result.epochs.back().time;
  if (frames.damaged() > 0) {
    refuse(result, bytes.size(),
           std::to_string(frames.damaged()) + " frames with a wrong checksum, or incomplete");
  }
  if (decoder.dropped() > 0) {
    refuse(result, bytes.size(),
           std::to_string(decoder.dropped()) +
               " measurements with unknown signals or impossible ranges");
  }
  return result;
}

}  // namespace maploop::ppp
