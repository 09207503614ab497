// This file defines what precise point positioning reports about one epoch of a GNSS receiver.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "msgs/local_frame.h"
#include "msgs/named_enum.h"
#include "msgs/protection_levels.h"
#include "msgs/sample.h"

namespace maploop {

// States how good the position of an epoch is.
enum class PppStatus : std::uint8_t {
  none,        // no position: the message states why
  converging,  // the ambiguities have not converged yet
  converged,   // horizontal standard deviation below 0.1 m
  fixed,       // the same, and its ambiguities are integers
};

constexpr auto names_of(PppStatus) {
  return names_up_to<PppStatus::fixed>({"none", "converging", "converged", "fixed"});
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

constexpr auto names_of(PppRefusal) {
  return names_up_to<PppRefusal::too_many>(
      {"", "no code and phase on the carriers used", "signal too weak",
       "no orbit or clock, or unhealthy", "below the elevation mask", "no phase",
       "code far from the others", "code does not fit", "phase does not fit",
       "Doppler does not fit", "no room for its ambiguity"});
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

constexpr auto names_of(PppSlip) {
  return names_up_to<PppSlip::phase_step>({"", "loss of lock", "geometry-free jump",
                                           "wide-lane jump", "Doppler disagrees",
                                           "not the others' step"});
}

// States how the road map affects the position (--map-mode tight).
enum class PppMap : std::uint8_t {
  none,    // there is no map, or no feedback from it yet
  aiding,  // the position is that of the filter with the map
  paused,  // switched off for a while after a wrong road
};

constexpr auto names_of(PppMap) {
  return names_up_to<PppMap::paused>({"none", "aiding", "paused"});
}

// This is one satellite of an epoch, and what of its measurements was used.
struct PppSatellite {
  char system = 'G';                      // RINEX's letter
  std::uint8_t number = 0;                // as RINEX 3 writes it
  float azimuth = 0.0F;                   // rad, clockwise from north
  float elevation = 0.0F;                 // rad; both are 0 without an ephemeris
  float cn0 = 0.0F;                       // dB-Hz
  bool code_used = false;                 // in the solution
  bool phase_used = false;                // in the solution
  float code_residual = 0.0F;             // m, after the update
  float phase_residual = 0.0F;            // m, after the update
  PppRefusal refusal = PppRefusal::none;  // why not all of it was used
  PppSlip slip = PppSlip::none;           // why its ambiguity restarted

  void archive(auto& ar) {
    ar(system, number, azimuth, elevation, cn0, code_used, phase_used, code_residual,
       phase_residual, refusal, slip);
  }
};

// `stamp` is the epoch's. Without a position, the position, the velocity, their
// covariances, the protection levels and the zenith delay are zero.
struct PppState : Sample {
  PppStatus status = PppStatus::none;  // none: there is no position
  std::string message;                 // why there is no position, and remarks about the epoch
  Geodetic position;                   // of the antenna's marker
  Eigen::Matrix3d position_covariance = Eigen::Matrix3d::Zero();  // m^2, east north up
  Eigen::Vector3d velocity_enu = Eigen::Vector3d::Zero();         // m/s
  Eigen::Matrix3d velocity_covariance = Eigen::Matrix3d::Zero();  // m^2/s^2
  ProtectionLevels protection;                                    // of the position
  double integrity_risk = 0.0;            // probability for each level, at one epoch
  double zenith_delay = 0.0;              // m, of the whole troposphere
  double zenith_delay_sigma = 0.0;        // m, its standard deviation
  double code_rms = 0.0;                  // m, of the residuals used
  double phase_rms = 0.0;                 // m, of the residuals used
  double converging_for = 0.0;            // s since the filter started or restarted
  std::uint64_t restarts = 0;             // how often it restarted
  PppMap map = PppMap::none;              // how the road map affects the position
  std::uint64_t roads_used = 0;           // lines of the map fed back so far
  std::uint64_t roads_refused = 0;        // lines too far away, without effect, or unusable
  std::int32_t satellites_used = 0;       // with their code, their phase or both
  std::int32_t satellites_corrected = 0;  // of those measured, by received corrections
  std::optional<double> correction_age;   // s, of the newest correction; nothing if none ever came
  std::vector<PppSatellite> satellites;   // all that were measured

  void archive(auto& ar) {
    ar(static_cast<Sample&>(*this), status, message, position, position_covariance, velocity_enu,
       velocity_covariance, protection, integrity_risk, zenith_delay, zenith_delay_sigma, code_rms,
       phase_rms, converging_for, restarts, map, roads_used, roads_refused, satellites_used,
       satellites_corrected, correction_age, satellites);
  }
};

}  // namespace maploop
