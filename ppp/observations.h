// Defines what a receiver measured, epoch by epoch.
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

// A Signal is one tracked signal of one satellite, named as in RINEX 3: band '1' and attribute 'C'
// is 1C. A value of zero means that it was not measured.
struct Signal {
  char band = 0, attribute = 0;
  bool lost_lock = false;   // the phase may have slipped since the previous epoch
  bool half_cycle = false;  // the phase may be wrong by half a cycle
  double code = 0.0;        // m
  double phase = 0.0;       // cycles, grows with distance
  double doppler = 0.0;     // Hz, positive when approaching
  double cn0 = 0.0;         // dB-Hz
};

struct SatelliteSignals {
  Satellite satellite;
  std::uint32_t first = 0, count = 0;  // the range within Epoch::signals
};

struct Epoch {
  GpsTime time{};
  bool power_failure = false;  // there was one between the previous epoch and this one
  double clock_offset = 0.0;   // s, of the receiver's clock; 0 if the file does not give it
  std::vector<SatelliteSignals> satellites;
  std::vector<Signal> signals;

  std::span<const Signal> of(const SatelliteSignals& s) const {
    return std::span(signals).subspan(s.first, s.count);
  }

  // Empties the epoch but keeps its memory.
  void clear() {
    time = {};
    power_failure = false;
    clock_offset = 0.0;
    satellites.clear();
    signals.clear();
  }
};

// An ObservationType is a column of an observation file.
struct ObservationType {
  char kind = 0;  // 'C' code, 'L' phase, 'D' Doppler, 'S' strength; other kinds are not kept
  char band = 0, attribute = 0;
  double factor = 1.0;  // the file's number is the value times this factor
  int signal = -1;      // index among the system's signals; -1: not kept
};

struct ObservationHeader {
  double version = 0.0;
  std::string marker, receiver, antenna, radome;
  std::optional<Eigen::Vector3d> approximate_position;  // m, ECEF
  Eigen::Vector3d antenna_delta_enu{0.0, 0.0, 0.0};     // m, marker to antenna reference point
  std::array<std::vector<ObservationType>, system_count> types;
  std::array<int, system_count> signals_of{};            // number of signals of each system
  std::array<std::optional<int>, 100> glonass_channels;  // by satellite number
  std::optional<GpsTime> first, last;
  double interval = 0.0;  // s; 0: not given
};

struct Observations {
  std::string file;
  ObservationHeader header;
  std::vector<Epoch> epochs;          // in the order of time
  std::vector<std::string> refusals;  // the first 20 reasons, as "file:line: why"
  int refused = 0;
};

}  // namespace maploop::ppp
