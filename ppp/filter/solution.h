// Defines the result of the PPP filter for one epoch.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "msgs/named_enum.h"
#include "msgs/ppp_state.h"
#include "ppp/gps_time.h"
#include "ppp/heights/height_use.h"
#include "ppp/satellite.h"

namespace maploop::ppp {

// States how the measurements of one satellite were used at an epoch.
struct SatelliteReport {
  Satellite satellite;                               // to which the rest belongs
  double azimuth = 0.0, elevation = 0.0;             // rad
  double cn0 = 0.0;                                  // dB-Hz
  bool code_used = false, phase_used = false;        // in the update
  bool integer = false;                              // its ambiguity is an integer in this solution
  double code_residual = 0.0, phase_residual = 0.0;  // m, after the update
  double ionosphere = 0.0;                           // m, estimated delay on GPS L1; 0: not used
  PppSlip slip = PppSlip::none;                      // why its ambiguity restarted
  PppRefusal refused = PppRefusal::none;             // why it was not used completely
};

// States whether an epoch's ambiguities are resolved to integers, and otherwise why not.
enum class IntegerOutcome : std::uint8_t {
  too_few,       // ambiguities that can be integers, and whose wide lane is known
  uncertain,     // their covariance is too large
  not_distinct,  // other integers fit nearly as well
  misfit,        // they contradict the real-valued ambiguities
  unconfirmed,   // they have changed recently
  used,
};

constexpr auto names_of(IntegerOutcome) {
  return names_up_to<IntegerOutcome::used>(
      {"too few", "uncertain", "not distinct", "misfit", "unconfirmed", "used"});
}

// Describes the search for the integers of an epoch: its outcome and the figures of its tests.
struct IntegerReport {
  IntegerOutcome outcome = IntegerOutcome::too_few;  // of this epoch
  int candidates = 0;         // differences of ambiguities whose wide lane is known
  int used = 0;               // satellites whose integer is used
  double success_rate = 0.0;  // probability that the integers are right, by the covariance
  double ratio = 0.0;         // squared distance of the second best integers to that of the best
  double margin = 0.0;        // by which the second best fits worse, in variances or misfits
  double misfit = 0.0;        // squared distance of the best for each ambiguity, in variances
};

// What the filter knew of an epoch before its measurements, from the solution before and from a
// motion of other sensors. Covariances are like those of the solution.
struct CarriedSolution {
  Eigen::Vector3d position{0, 0, 0};                              // m, earth-fixed
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();           // m^2, earth-fixed
  Eigen::Vector3d velocity{0, 0, 0};                              // m/s
  Eigen::Matrix3d velocity_covariance = Eigen::Matrix3d::Zero();  // m^2/s^2, earth-fixed
  Eigen::Matrix3d growth = Eigen::Matrix3d::Zero();  // m^2, of the covariance, by the motion alone
};

// A PppSolution is what the filter knows after an epoch.
struct PppSolution {
  GpsTime time{};                      // of the epoch
  PppStatus status = PppStatus::none;  // none: there is no position
  // Fewer than four satellites were used, so that the status is none, but what they and the motion
  // say is known well enough for the position, velocity and covariances to be reported.
  bool bridged = false;
  std::string message;                // why there is no solution; "started again: ..."
  Eigen::Vector3d position{0, 0, 0};  // m, of the marker, earth-fixed
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();           // m^2, earth-fixed
  Eigen::Vector3d velocity{0, 0, 0};                              // m/s
  Eigen::Matrix3d velocity_covariance = Eigen::Matrix3d::Zero();  // m^2/s^2, earth-fixed
  std::optional<CarriedSolution> carried;  // nothing: not known, or the integers' solution
  double clock = 0.0;                      // m
  double zenith_delay = 0.0, zenith_delay_sigma = 0.0;  // m, of the whole troposphere
  double running_for = 0.0;                             // s since the filter started or restarted
  std::uint64_t restarts = 0;                           // number of restarts
  int satellites_used = 0;                              // those whose code or phase was used
  HeightUse height_use = HeightUse::not_asked;          // of the ground's height
  IntegerReport integers;                               // whether and why ambiguities are integers
  std::vector<SatelliteReport> satellites;              // all that were measured

  // Returns whether there is a position, measured or bridged.
  bool has_position() const { return status != PppStatus::none || bridged; }
};

}  // namespace maploop::ppp
