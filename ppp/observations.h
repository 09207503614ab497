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
  char band = 0, attribute = 0;  // as in RINEX 3
  bool lost_lock = false;        // the phase may have slipped since the previous epoch
  bool half_cycle = false;       // the phase may be wrong by half a cycle
  double code = 0.0;             // m
  double phase = 0.0;            // cycles, grows with distance
  double doppler = 0.0;          // Hz, positive when approaching
  double cn0 = 0.0;              // dB-Hz
};

// Holds which signals of an epoch are those of one satellite.
struct SatelliteSignals {
  Satellite satellite;                 // whose signals these are
  std::uint32_t first = 0, count = 0;  // the range within Epoch::signals
};

// An Epoch holds what a receiver measured at one time.
struct Epoch {
  GpsTime time{};              // of the measurements, by the receiver's clock
  bool power_failure = false;  // there was one between the previous epoch and this one
  double clock_offset = 0.0;   // s, of the receiver's clock; 0 if the file does not give it
  std::vector<SatelliteSignals> satellites;  // those measured
  std::vector<Signal> signals;               // of all satellites, one after another

  // Returns the signals of one of its satellites; valid while `signals` does not change.
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
  char band = 0, attribute = 0;  // as in RINEX 3
  double factor = 1.0;           // the file's number is the value times this factor
  int signal = -1;               // index among the system's signals; -1: not kept
};

// Holds what a file states about its receiver and its columns. Streams give a part of it.
struct ObservationHeader {
  double version = 0.0;                                 // of RINEX; 0: of a stream
  std::string marker, receiver, antenna, radome;        // names of these; empty: not given
  std::optional<Eigen::Vector3d> approximate_position;  // m, ECEF
  Eigen::Vector3d antenna_delta_enu{0.0, 0.0, 0.0};     // m, marker to antenna reference point
  // The columns of each System, in the order of the file.
  std::array<std::vector<ObservationType>, system_count> types;
  std::array<int, system_count> signals_of{};            // number of signals of each system
  std::array<std::optional<int>, 100> glonass_channels;  // by satellite number
  std::optional<GpsTime> first, last;                    // epochs of the file; nothing: not given
  double interval = 0.0;                                 // s; 0: not given
};

// Holds the content of one file of observations.
struct Observations {
  std::string file;                   // path or name, for messages
  ObservationHeader header;           // with the columns last in force
  std::vector<Epoch> epochs;          // in the order of time
  std::vector<std::string> refusals;  // the first 20 reasons, with file and line (or byte)
  int refused = 0;                    // number of refusals, also of those without their reason here
};

}  // namespace maploop::ppp
