// What a receiver measured, by epochs.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ppp/gps_time.h"
#include "ppp/satellite.h"

namespace maploop::ppp {

// One tracked signal of one satellite, named as in RINEX 3: band '1' and attribute 'C' is 1C.
// Zero: not measured.
struct Signal {
  char band = 0, attribute = 0;
  bool lost_lock = false;   // the phase may have slipped since the epoch before
  bool half_cycle = false;  // the phase may be wrong by half a cycle
  double code = 0.0;        // m
  double phase = 0.0;       // cycles, grows with distance
  double doppler = 0.0;     // Hz, positive when approaching
  double cn0 = 0.0;         // dB-Hz
};

struct SatelliteSignals {
  Satellite satellite;
  std::uint32_t first = 0, count = 0;  // of Epoch::signals
};

struct Epoch {
  GpsTime time{};
  bool power_failure = false;  // between the epoch before and this one
  double clock_offset = 0.0;   // s, of the receiver, where the file says it
  std::vector<SatelliteSignals> satellites;
  std::vector<Signal> signals;

  std::span<const Signal> of(const SatelliteSignals& s) const {
    return std::span(signals).subspan(s.first, s.count);
  }

  // Keeps the memory.
  void clear() {
    time = {};
    power_failure = false;
    clock_offset = 0.0;
    satellites.clear();
    signals.clear();
  }
};

// A column of an observation file.
struct ObservationType {
  char kind = 0;  // 'C' code, 'L' phase, 'D' Doppler, 'S' strength; another kind is not kept
  char band = 0, attribute = 0;
  double factor = 1.0;  // the file's numbers are this many times the value
  int signal = -1;      // place among the system's signals
};

struct ObservationHeader {
  double version = 0.0;
  std::string marker, receiver, antenna, radome;
  std::optional<Eigen::Vector3d> approximate_position;  // m, ECEF
  Eigen::Vector3d antenna_delta_enu{0.0, 0.0, 0.0};     // m, marker to antenna reference point
  std::array<std::vector<ObservationType>, system_count> types;
  std::array<int, system_count> signals_of{};            // signals of a system's types
  std::array<std::optional<int>, 100> glonass_channels;  // by number
  std::optional<GpsTime> first, last;
  double interval = 0.0;  // s; 0: not said
};

struct Observations {
  std::string file;
  ObservationHeader header;
  std::vector<Epoch> epochs;          // in the order of time
  std::vector<std::string> refusals;  // what was left out, "file:line: why"; see refused
  int refused = 0;
};

}  // namespace maploop::ppp
