// This file defines what precise point positioning reports about one epoch of a GNSS receiver.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/local_frame.h"
#include "msgs/sample.h"

namespace maploop {

enum class PppStatus : std::uint8_t {
  none,        // no position: the message states why
  converging,  // the ambiguities have not converged yet
  converged,   // horizontal standard deviation below 0.1 m
};

constexpr std::size_t ppp_status_count = static_cast<std::size_t>(PppStatus::converged) + 1;

constexpr std::string_view to_string(PppStatus status) {
  switch (status) {
    case PppStatus::none:
      return "none";
    case PppStatus::converging:
      return "converging";
    case PppStatus::converged:
      return "converged";
  }
  return "unknown";
}

// States why a satellite, or a part of its measurements, was not used.
enum class PppRefusal : std::uint8_t {
  none,
  no_signals,    // a carrier lacks its code or its phase
  weak,          // below the mask of signal strength
  no_ephemeris,  // not covered by products and messages, or marked unhealthy
  low,           // below the elevation mask
  no_phase,      // only its code was used
  code_far,      // its code is far from all others
  code_misfit,   // beyond the limit after the update, like the two below
  phase_misfit,  // its ambiguity restarts
  doppler_misfit,
  too_many,  // the filter has no room for one more
};

constexpr std::size_t ppp_refusal_count = static_cast<std::size_t>(PppRefusal::too_many) + 1;

constexpr std::string_view to_string(PppRefusal refusal) {
  switch (refusal) {
    case PppRefusal::none:
      return "";
    case PppRefusal::no_signals:
      return "no code and phase on the carriers used";
    case PppRefusal::weak:
      return "signal too weak";
    case PppRefusal::no_ephemeris:
      return "no orbit or clock, or unhealthy";
    case PppRefusal::low:
      return "below the elevation mask";
    case PppRefusal::no_phase:
      return "no phase";
    case PppRefusal::code_far:
      return "code far from the others";
    case PppRefusal::code_misfit:
      return "code does not fit";
    case PppRefusal::phase_misfit:
      return "phase does not fit";
    case PppRefusal::doppler_misfit:
      return "Doppler does not fit";
    case PppRefusal::too_many:
      return "no room for its ambiguity";
  }
  return "unknown";
}

// States how a slip of the phase was detected; the ambiguity then restarts.
enum class PppSlip : std::uint8_t {
  none,
  lost_lock,
  geometry_free,
  wide_lane,
  doppler,
  phase_step,  // with one carrier: its change differs from the others'
};

constexpr std::size_t ppp_slip_count = static_cast<std::size_t>(PppSlip::phase_step) + 1;

constexpr std::string_view to_string(PppSlip slip) {
  switch (slip) {
    case PppSlip::none:
      return "";
    case PppSlip::lost_lock:
      return "loss of lock";
    case PppSlip::geometry_free:
      return "geometry-free jump";
    case PppSlip::wide_lane:
      return "wide-lane jump";
    case PppSlip::doppler:
      return "Doppler disagrees";
    case PppSlip::phase_step:
      return "not the others' step";
  }
  return "unknown";
}

// States how the road map affects the position (--map-mode tight).
enum class PppMap : std::uint8_t {
  none,    // there is no map, or no feedback from it yet
  aiding,  // the position is that of the filter with the map
  paused,  // switched off for a while after a wrong road
};

constexpr std::size_t ppp_map_count = static_cast<std::size_t>(PppMap::paused) + 1;

constexpr std::string_view to_string(PppMap map) {
  switch (map) {
    case PppMap::none:
      return "none";
    case PppMap::aiding:
      return "aiding";
    case PppMap::paused:
      return "paused";
  }
  return "unknown";
}

struct PppSatellite {
  char system = 'G';        // RINEX's letter
  std::uint8_t number = 0;  // as RINEX 3 writes it
  float azimuth = 0.0F;     // rad, clockwise from north
  float elevation = 0.0F;   // rad; both are 0 without an ephemeris
  float cn0 = 0.0F;         // dB-Hz
  bool code_used = false;
  bool phase_used = false;
  float code_residual = 0.0F;  // m, after the update
  float phase_residual = 0.0F;
  PppRefusal refusal = PppRefusal::none;
  PppSlip slip = PppSlip::none;
};

template <class Archive>
void archive(Archive& ar, PppSatellite& s) {
  ar(s.system, s.number, s.azimuth, s.elevation, s.cn0, s.code_used, s.phase_used, s.code_residual,
     s.phase_residual, s.refusal, s.slip);
}

// Each is a distance from the position that contains the antenna except with the probability
// `integrity_risk`; along and across the direction of travel, and up.
struct ProtectionLevels {
  double along = 0.0, across = 0.0, up = 0.0;  // m
};

template <class Archive>
void archive(Archive& ar, ProtectionLevels& p) {
  ar(p.along, p.across, p.up);
}

// `stamp` is the epoch's. Without a position everything but satellites and message is zero.
struct PppState : Sample {
  PppStatus status = PppStatus::none;
  std::string message;  // why there is no position, and remarks about the epoch
  Geodetic position;    // of the antenna's marker
  Eigen::Matrix3d position_covariance = Eigen::Matrix3d::Zero();  // m^2, east north up
  Eigen::Vector3d velocity_enu = Eigen::Vector3d::Zero();         // m/s
  Eigen::Matrix3d velocity_covariance = Eigen::Matrix3d::Zero();  // m^2/s^2
  ProtectionLevels protection;
  double integrity_risk = 0.0;  // probability for each level, at one epoch
  double zenith_delay = 0.0;    // m, of the whole troposphere
  double zenith_delay_sigma = 0.0;
  double code_rms = 0.0;        // m, of the residuals used
  double phase_rms = 0.0;       // m
  double converging_for = 0.0;  // s since the filter started or restarted
  std::uint64_t restarts = 0;   // how often it restarted
  PppMap map = PppMap::none;
  std::uint64_t roads_used = 0;     // lines of the map fed back so far
  std::uint64_t roads_refused = 0;  // lines too far away, without effect, or unusable
  std::int32_t satellites_used = 0;
  std::int32_t satellites_corrected = 0;  // of those measured, by received corrections
  std::optional<double> correction_age;   // s, of the newest correction; nothing if none ever came
  std::vector<PppSatellite> satellites;   // all that were measured
};

template <class Archive>
void archive(Archive& ar, PppState& s) {
  ar(static_cast<Sample&>(s), s.status, s.message, s.position, s.position_covariance,
     s.velocity_enu, s.velocity_covariance, s.protection, s.integrity_risk, s.zenith_delay,
     s.zenith_delay_sigma, s.code_rms, s.phase_rms, s.converging_for, s.restarts, s.map,
     s.roads_used, s.roads_refused, s.satellites_used, s.satellites_corrected, s.correction_age,
     s.satellites);
}

}  // namespace maploop
