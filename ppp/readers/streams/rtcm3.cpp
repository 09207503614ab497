#include "ppp/readers/streams/rtcm3.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "ppp/readers/streams/rtcm3_signals.h"

namespace maploop::ppp {
namespace {

constexpr double metres_of_ms = speed_of_light * 1e-3;

struct Kind {
  System system;
  int msm;  // 4 to 7
};

std::optional<Kind> kind_of(int number) {
  constexpr std::array systems{System::gps,  System::glonass, System::galileo,
                               System::sbas, System::qzss,    System::beidou};
  const int row = (number - 1070) / 10, msm = number % 10;
  if (number < 1070 || row >= static_cast<int>(systems.size()) || msm < 4 || msm > 7) return {};
  return Kind{systems[static_cast<std::size_t>(row)], msm};
}

// A Layout has the field widths of each cell, and the units of ranges as powers of two, ms.
struct Layout {
  bool rates;
  std::size_t code_bits, phase_bits, lock_bits, cn0_bits;
  int code_power, phase_power;
  double cn0_unit;  // dB-Hz
};

Layout layout_of(int msm) {
  const bool high = msm >= 6;
  return {msm == 5 || msm == 7, high ? 20U : 15U, high ? 24U : 22U, high ? 10U : 4U,
          high ? 10U : 6U,      high ? -29 : -24, high ? -31 : -29, high ? 1.0 / 16.0 : 1.0};
}

// Converts a number in units of 2^power ms; nothing for the value that marks it as missing.
std::optional<double> fine_range(std::int64_t value, std::size_t bits, int power) {
  if (value == -(std::int64_t{1} << (bits - 1))) return {};
  return std::ldexp(static_cast<double>(value), power);
}

constexpr Duration week = std::chrono::hours(24 * 7);

}  // namespace

// Contains a message's satellites, cells and their values.
struct MsmDecoder::Header {
  System system{};
  Layout layout{};
  std::vector<Satellite> satellites;
  std::vector<std::string_view> signals;
  std::uint64_t cells = 0;  // one bit per cell, satellite by satellite, the first one highest
  std::size_t cell_places = 0;
  std::vector<std::optional<double>> range_ms, rate;  // of each satellite
  // The following have one entry for each cell that is present.
  std::vector<std::optional<double>> code_ms, phase_ms, fine_rate;
  std::vector<int> lock;
  std::vector<bool> half_cycle;
  std::vector<double> cn0;

  bool has(std::size_t place) const { return (cells >> (cell_places - 1 - place) & 1U) != 0; }
  bool read(Rtcm3Bits& bits, int msm, std::array<std::optional<int>, 100>& channels);
};

bool MsmDecoder::Header::read(Rtcm3Bits& bits, int msm,
                              std::array<std::optional<int>, 100>& channels) {
  layout = layout_of(msm);
  constexpr std::size_t after_multiple = 3 + 7 + 2 + 2 + 1 + 3;
  bits.skip(after_multiple);
  const std::uint64_t satellite_mask = bits.number(64), signal_mask = bits.number(32);
  std::vector<std::optional<Satellite>> found;
  for (int place = 1; place <= 64; ++place) {
    if ((satellite_mask >> (64 - place) & 1U) != 0) found.push_back(msm_satellite(system, place));
  }
  for (int place = 1; place <= 32; ++place) {
    if ((signal_mask >> (32 - place) & 1U) != 0) signals.push_back(msm_signal(system, place));
  }
  cell_places = found.size() * signals.size();
  if (cell_places == 0 || cell_places > 64) return false;
  for (const auto& satellite : found) {
    if (!satellite) return false;
    satellites.push_back(*satellite);
  }
  cells = bits.number(cell_places);
  const std::size_t count = satellites.size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto ms = bits.number(8);
    range_ms.push_back(ms == 255 ? std::nullopt : std::optional<double>(static_cast<double>(ms)));
  }
  if (layout.rates) {
    for (const Satellite s : satellites) {
      const int channel = static_cast<int>(bits.number(4)) - 7;
      if (system == System::glonass && channel <= 6) channels[s.number] = channel;
    }
  }
  for (auto& range : range_ms) {
    const double part = static_cast<double>(bits.number(10)) / 1024.0;
    if (range) *range += part;
  }
  rate.assign(count, std::nullopt);
  for (std::size_t i = 0; layout.rates && i < count; ++i) {
    const auto value = bits.signed_number(14);
    if (value != -8192) rate[i] = static_cast<double>(value);
  }
  const auto present = static_cast<std::size_t>(std::popcount(cells));
  for (std::size_t i = 0; i < present; ++i) {
    code_ms.push_back(
        fine_range(bits.signed_number(layout.code_bits), layout.code_bits, layout.code_power));
  }
  for (std::size_t i = 0; i < present; ++i) {
    phase_ms.push_back(
        fine_range(bits.signed_number(layout.phase_bits), layout.phase_bits, layout.phase_power));
  }
  for (std::size_t i = 0; i < present; ++i) {
    lock.push_back(static_cast<int>(bits.number(layout.lock_bits)));
  }
  for (std::size_t i = 0; i < present; ++i) half_cycle.push_back(bits.number(1) != 0);
  for (std::size_t i = 0; i < present; ++i) {
    cn0.push_back(layout.cn0_unit * static_cast<double>(bits.number(layout.cn0_bits)));
  }
  fine_rate.assign(present, std::nullopt);
  for (std::size_t i = 0; layout.rates && i < present; ++i) {
    const auto value = bits.signed_number(15);
    if (value != -16384) fine_rate[i] = 1e-4 * static_cast<double>(value);
  }
  return bits.good();
}

std::optional<GpsTime> MsmDecoder::time_of(System system, std::uint64_t field) const {
  using std::chrono::milliseconds;
  if (system == System::glonass) {
    // The field contains the day of the week and the time of day in Moscow, UTC plus three hours.
    const auto ms = static_cast<std::int64_t>(field & ((1U << 27) - 1));
    if (ms > 86'401'000) return {};
    const Duration since =
        milliseconds(ms) - std::chrono::hours(3) + leap_seconds(now_).gps_minus_utc;
    return nearest_moment(now_, since, std::chrono::hours(24));
  }
  const auto ms = static_cast<std::int64_t>(field);
  if (ms >= week / milliseconds(1)) return {};
  const Duration to_gps =
      system == System::beidou ? Duration(std::chrono::seconds(14)) : Duration{};
  return nearest_moment(now_, milliseconds(ms) + to_gps, week);
}

void MsmDecoder::add(const Header& header) {
  std::size_t cell = 0;
  for (std::size_t i = 0; i < header.satellites.size(); ++i) {
    const Satellite satellite = header.satellites[i];
    const bool again =
        std::any_of(open_.satellites.begin(), open_.satellites.end(),
                    [&](const SatelliteSignals& s) { return s.satellite == satellite; });
    const auto first = open_.signals.size();
    for (std::size_t k = 0; k < header.signals.size(); ++k) {
      if (!header.has(i * header.signals.size() + k)) continue;
      const std::size_t at = cell++;
      if (again || header.signals[k].empty() || !header.range_ms[i]) {
        ++dropped_;
        continue;
      }
      const Signal signal = signal_of(header, i, header.signals[k], at);
      if (signal.code != 0.0 || signal.phase != 0.0) open_.signals.push_back(signal);
    }
    if (open_.signals.size() > first) {
      open_.satellites.push_back({satellite, static_cast<std::uint32_t>(first),
                                  static_cast<std::uint32_t>(open_.signals.size() - first)});
    }
  }
}

Signal MsmDecoder::signal_of(const Header& header, std::size_t satellite, std::string_view name,
                             std::size_t cell) {
  const Key key{header.satellites[satellite], name[0], name[1]};
  const double rough = *header.range_ms[satellite];
  Signal signal{.band = key.band, .attribute = key.attribute};
  signal.cn0 = header.cn0[cell];
  if (header.code_ms[cell]) {
    const double code = metres_of_ms * (rough + *header.code_ms[cell]);
    // As in files, no navigation satellite is nearer than 15000 km or farther than 80000 km.
    if (code > 1.0e7 && code < 1.0e8) {
      signal.code = code;
    } else {
      ++dropped_;
      return signal;
    }
  }
  const auto channel = key.satellite.system == System::glonass
                           ? glonass_channels_[key.satellite.number]
                           : std::nullopt;
  const double cycles_per_metre =
      carrier_frequency(key.satellite.system, key.band, channel) / speed_of_light;
  // The indicator grows with the time of lock, but is too coarse for a signal that was missing in
  // the previous epoch: its phase counts as slipped.
  Tracked& tracked = tracked_[key];
  const bool slipped = header.lock[cell] == 0 || header.lock[cell] < tracked.lock ||
                       (tracked.seen && tracked.last < now_);
  tracked = {true, open_.time, header.lock[cell]};
  if (header.phase_ms[cell]) {
    if (cycles_per_metre > 0.0) {
      signal.phase = metres_of_ms * (rough + *header.phase_ms[cell]) * cycles_per_metre;
      signal.lost_lock = slipped;
      signal.half_cycle = header.half_cycle[cell];
    } else {
      ++dropped_;
    }
  }
  if (header.rate[satellite] && header.fine_rate[cell]) {
    signal.doppler = -(*header.rate[satellite] + *header.fine_rate[cell]) * cycles_per_metre;
  }
  return signal;
}

bool MsmDecoder::finish(Epoch& epoch) {
  if (open_.satellites.empty()) return false;
  now_ = open_.time;
  std::swap(epoch, open_);
  open_.clear();
  return true;
}

bool MsmDecoder::decode(const Rtcm3Message& message, Epoch& epoch, std::string& problem) {
  problem.clear();
  const auto kind = kind_of(message.number);
  if (!kind) return false;
  constexpr std::size_t number_and_station = 24;
  Rtcm3Bits bits(message.payload);
  bits.skip(number_and_station);
  const auto time = time_of(kind->system, bits.number(30));
  const bool more = bits.number(1) != 0;
  Header header;
  header.system = kind->system;
  if (!time || !header.read(bits, kind->msm, glonass_channels_)) {
    problem = "message " + std::to_string(message.number) +
              (time ? " has incomplete content" : " has no valid time");
    return false;
  }
  const bool next_began = open_.time != *time && finish(epoch);
  open_.time = *time;
  add(header);
  if (next_began) return true;  // an already complete epoch follows with the next message
  return !more && finish(epoch);
}

}  // namespace maploop::ppp
