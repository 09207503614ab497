// Makes what receivers and casters send: UBX and RTCM 3 frames. It shares no code with the
// decoders, except for the tables of an ephemeris's fields.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ppp/observations.h"
#include "ppp/readers/corrections/ssr.h"
#include "ppp/readers/files/broadcast_fields.h"
#include "ppp/readers/files/navigation.h"
#include "tests/support/bit_writer.h"
#include "tests/support/ubx_frame.h"

namespace maploop::testing {

// Returns a whole RTCM 3 frame; the checksum is computed bit by bit.
inline std::string rtcm_frame(const BitWriter& payload) {
  const std::string bytes = payload.bytes();
  std::string f{'\xd3', static_cast<char>(bytes.size() >> 8),
                static_cast<char>(bytes.size() & 0xff)};
  f += bytes;
  std::uint32_t crc = 0;
  for (const char c : f) {
    crc ^= static_cast<std::uint32_t>(static_cast<std::uint8_t>(c)) << 16;
    for (int i = 0; i < 8; ++i) crc = (crc << 1) ^ ((crc & 0x800000U) != 0 ? 0x1864cfbU : 0U);
    crc &= 0xffffffU;
  }
  for (const int shift : {16, 8, 0}) f += static_cast<char>(crc >> shift);
  return f;
}

// Returns a GPS ephemeris in which only the satellite and the week are set.
inline std::string gps_week_frame(int week) {
  BitWriter w;
  w.put(1019, 12).put(5, 6).put(static_cast<std::uint64_t>(week) % 1024, 10).put(0, 460);
  return rtcm_frame(w);
}

// Returns a RAWX message of the signals of an epoch for which u-blox has a number. The lock time
// never ends, except where lock was lost.
inline std::string rawx_frame(const ppp::Epoch& epoch) {
  struct Named {
    ppp::System system;
    char band, attribute;
    int gnss, signal;
  };
  using enum ppp::System;
  constexpr std::array names{Named{gps, '1', 'C', 0, 0},     Named{gps, '2', 'L', 0, 3},
                             Named{gps, '5', 'Q', 0, 7},     Named{galileo, '1', 'C', 2, 0},
                             Named{galileo, '5', 'Q', 2, 4}, Named{galileo, '7', 'Q', 2, 6}};
  std::string measurements;
  int count = 0;
  for (const ppp::SatelliteSignals& s : epoch.satellites) {
    for (const ppp::Signal& signal : epoch.of(s)) {
      for (const Named& n : names) {
        if (n.system != s.satellite.system || n.band != signal.band ||
            n.attribute != signal.attribute)
          continue;
        const int status = (signal.code != 0.0) | (signal.phase != 0.0) << 1 | 4;
        measurements +=
            raw_bytes(signal.code) + raw_bytes(signal.phase) +
            raw_bytes(static_cast<float>(signal.doppler)) +
            std::string{static_cast<char>(n.gnss), static_cast<char>(s.satellite.number),
                        static_cast<char>(n.signal), 0} +
            raw_bytes(static_cast<std::uint16_t>(signal.lost_lock ? 0 : 64'500)) +
            std::string{
                static_cast<char>(std::lround(signal.cn0)), 3, 3, 3, static_cast<char>(status), 0};
        ++count;
      }
    }
  }
  return ubx_frame(0x02, 0x15,
                   raw_bytes(ppp::seconds_of_week(epoch.time)) +
                       raw_bytes(static_cast<std::uint16_t>(ppp::gps_week(epoch.time))) +
                       std::string{18, static_cast<char>(count), 1, 1, 0, 0} + measurements);
}

// Returns the values of a message as its fields contain them, sent in this week since 1980.
inline ppp::BroadcastValues broadcast_values(const ppp::KeplerMessage& m, int week) {
  using ppp::Quantity, ppp::System;
  ppp::BroadcastValues v{};
  const auto set = [&](Quantity q, double value) { v[static_cast<std::size_t>(q)] = value; };
  const bool beidou = m.satellite.system == System::beidou;
  const bool galileo = m.satellite.system == System::galileo;
  const Duration to_gps = beidou ? Duration(std::chrono::seconds(14)) : Duration::zero();
  set(Quantity::week, galileo ? week - 1024 : beidou ? week - 1356 : week % 1024);
  set(Quantity::toc, ppp::seconds_of_week(m.toc - to_gps));
  const double toe = ppp::seconds_of_week(m.toe - to_gps);
  const double high = beidou ? std::floor(toe / 262144.0) * 262144.0 : 0.0;
  set(Quantity::toe, toe - high);
  set(Quantity::toe_high, high);
  set(Quantity::af0, m.af0), set(Quantity::af1, m.af1), set(Quantity::af2, m.af2);
  set(Quantity::iode, m.iode), set(Quantity::crs, m.crs), set(Quantity::delta_n, m.delta_n);
  set(Quantity::m0, m.m0), set(Quantity::cuc, m.cuc), set(Quantity::e, m.e);
  set(Quantity::cus, m.cus), set(Quantity::sqrt_a, m.sqrt_a), set(Quantity::cic, m.cic);
  set(Quantity::omega0, m.omega0), set(Quantity::cis, m.cis), set(Quantity::i0, m.i0);
  set(Quantity::crc, m.crc), set(Quantity::omega, m.omega), set(Quantity::omega_dot, m.omega_dot);
  set(Quantity::i_dot, m.i_dot), set(Quantity::group_delay, m.group_delay[0]);
  set(Quantity::second_group_delay, m.group_delay[1]);
  set(Quantity::accuracy, galileo ? 107 : 0);  // 3.12 m; 2.4 m
  if (galileo) {
    const auto health = static_cast<unsigned>(m.health);
    set(Quantity::e1_validity, health & 1U), set(Quantity::e1_health, health >> 1 & 3U);
    set(Quantity::e5b_validity, health >> 6 & 1U), set(Quantity::e5b_health, health >> 7 & 3U);
  } else {
    set(Quantity::health, m.health);
  }
  return v;
}

// Returns 1019 for GPS or 1045 for Galileo (whatever signals its clock is for, and without its
// health); empty for other systems.
inline std::string rtcm_ephemeris(const ppp::KeplerMessage& m) {
  const bool galileo = m.satellite.system == ppp::System::galileo;
  if (!galileo && m.satellite.system != ppp::System::gps) return {};
  ppp::KeplerMessage healthy = m;
  healthy.health = 0.0;
  const ppp::BroadcastValues v = broadcast_values(healthy, ppp::gps_week(m.toe));
  BitWriter w;
  w.put(galileo ? 1045 : 1019, 12).put(m.satellite.number, 6);
  w.put(galileo ? std::span<const ppp::BroadcastField>(ppp::broadcast_fields::rtcm_galileo)
                : std::span<const ppp::BroadcastField>(ppp::broadcast_fields::rtcm_1019),
        v);
  if (galileo) w.put(ppp::broadcast_fields::rtcm_1045_end, v);
  return rtcm_frame(w);
}

enum class SsrForm { rtcm, igs };

// Puts the beginning of a message behind its number: every 5 s, the first issue of one solution.
// `datum` states whether there is a flag for a regional reference frame.
inline void put_ssr_header(BitWriter& w, ppp::GpsTime epoch, bool datum = false) {
  w.put(static_cast<std::uint64_t>(std::lround(ppp::seconds_of_week(epoch))), 20)
      .put(2, 4)
      .put(0, 1);
  if (datum) w.put(0, 1);
  w.put(3, 4).put(258, 16).put(1, 4);
}

// Returns orbits and clocks of one system (GPS or Galileo) in one message. A decoder should count
// from `epoch` plus half the interval of 5 s.
inline std::string ssr_orbits_and_clocks(SsrForm form, ppp::System system, ppp::GpsTime epoch,
                                         const std::vector<ppp::SsrUpdate>& updates) {
  const bool galileo = system == ppp::System::galileo, igs = form == SsrForm::igs;
  BitWriter w;
  w.put(igs ? 4076 : galileo ? 1243 : 1060, 12);
  if (igs) w.put(1, 3).put(galileo ? 63 : 23, 8);
  put_ssr_header(w, epoch, !igs);
  if (igs) w.put(0, 1);
  w.put(updates.size(), 6);
  for (const ppp::SsrUpdate& u : updates) {
    const ppp::SsrOrbit& o = *u.orbit;
    w.put(u.satellite.number, 6).put(static_cast<std::uint64_t>(o.issue), galileo && !igs ? 10 : 8);
    w.put(o.offset.x(), 1e-4, 22).put(o.offset.y(), 4e-4, 20).put(o.offset.z(), 4e-4, 20);
    w.put(o.offset_rate.x(), 1e-6, 21).put(o.offset_rate.y(), 4e-6, 19);
    w.put(o.offset_rate.z(), 4e-6, 19);
    const auto& c = u.clock->polynomial;
    w.put(c[0], 1e-4, 22).put(c[1], 1e-6, 21).put(c[2], 2e-8, 27);
  }
  return rtcm_frame(w);
}

// This is the bias of a signal, by the numbers of the standard.
struct NumberedBias {
  std::uint8_t satellite;
  int signal;
  double value;  // m
};

// Puts the biases of each satellite, which come together. `between` writes what is between their
// number and the first, `each` what is behind a signal's number.
template <class Between, class Each>
void put_biases(BitWriter& w, const std::vector<NumberedBias>& biases, Between between, Each each) {
  std::vector<std::uint8_t> satellites;
  for (const NumberedBias& b : biases) {
    if (satellites.empty() || satellites.back() != b.satellite) satellites.push_back(b.satellite);
  }
  w.put(satellites.size(), 6);
  for (const std::uint8_t satellite : satellites) {
    const auto of = [&](const NumberedBias& b) { return b.satellite == satellite; };
    w.put(satellite, 6);
    w.put(static_cast<std::uint64_t>(std::count_if(biases.begin(), biases.end(), of)), 5);
    between();
    for (const NumberedBias& b : biases) {
      if (of(b)) each(w.put(static_cast<std::uint64_t>(b.signal), 5), b.value);
    }
  }
}

// Returns code biases of GPS (1059) or Galileo (1242).
inline std::string ssr_biases(ppp::System system, ppp::GpsTime epoch,
                              const std::vector<NumberedBias>& biases) {
  BitWriter w;
  w.put(system == ppp::System::galileo ? 1242 : 1059, 12);
  put_ssr_header(w, epoch);
  put_biases(
      w, biases, [] {}, [](BitWriter& to, double value) { to.put(value, 0.01, 14); });
  return rtcm_frame(w);
}

// Returns phase biases of GPS or Galileo with which ambiguities are integers. All have jumped
// `jumps` times.
inline std::string ssr_phase_biases(SsrForm form, ppp::System system, ppp::GpsTime epoch,
                                    const std::vector<NumberedBias>& biases,
                                    std::uint64_t jumps = 0) {
  const bool galileo = system == ppp::System::galileo, igs = form == SsrForm::igs;
  BitWriter w;
  w.put(igs ? 4076 : galileo ? 1267 : 1265, 12);
  if (igs) w.put(1, 3).put(galileo ? 66 : 26, 8);
  put_ssr_header(w, epoch);
  w.put(3, 2);  // consistent with the dispersive part and with wide lanes
  put_biases(
      w, biases, [&] { w.put(0, 9 + 8); },
      [&](BitWriter& to, double value) {
        to.put(1, 1).put(2, 2).put(jumps, 4).put(value, 1e-4, 20);
      });
  return rtcm_frame(w);
}

// Returns the electrons of one layer at 450 km, with a standard deviation of 2 TECU.
inline std::string ssr_ionosphere(SsrForm form, ppp::GpsTime epoch, const ppp::SsrLayer& layer) {
  const bool igs = form == SsrForm::igs;
  BitWriter w;
  w.put(igs ? 4076 : 1264, 12);
  if (igs) w.put(1, 3).put(201, 8);
  put_ssr_header(w, epoch);
  w.put(2.0, 0.05, 9).put(0, 2).put(45, 8);
  w.put(static_cast<std::uint64_t>(layer.degree - 1), 4);
  w.put(static_cast<std::uint64_t>(layer.order - 1), 4);
  for (const auto* values : {&layer.cosines, &layer.sines}) {
    for (const double value : *values) w.put(value, 0.005, 16);
  }
  return rtcm_frame(w);
}

}  // namespace maploop::testing
