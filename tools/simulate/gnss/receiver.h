// Simulates a geodetic receiver with two frequencies on the car's roof.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <optional>
#include <vector>

#include "msgs/local_frame.h"
#include "ppp/gps_time.h"
#include "ppp/models/earth.h"
#include "tools/simulate/gnss/atmosphere.h"
#include "tools/simulate/gnss/constellation.h"
#include "tools/simulate/gnss/tracking.h"
#include "tools/simulate/sensors/vehicle_motion.h"

namespace maploop::simulate {

// The phase centre of the receiver's antenna on a carrier, relative to its reference point; m.
struct ReceiveAntenna {
  Eigen::Vector3d offset;              // right, forward, up
  std::array<double, 19> variation{};  // at 0 to 90 degrees from the zenith

  double delay(const Eigen::Vector3d& to_satellite) const;  // m, for a unit vector in these axes
};
// Returns the antenna of both carriers as its calibration file describes it.
std::array<ReceiveAntenna, 2> calibrated_antenna();

struct ObservedSignal {
  double code = 0.0;            // m
  std::optional<double> phase;  // cycles
  double doppler = 0.0;         // Hz
  double cn0 = 0.0;             // dB-Hz
  bool lost_lock = false;
};
struct ObservedSatellite {
  ppp::Satellite satellite;
  std::array<std::optional<ObservedSignal>, 2> signals;  // in the order of bands()
};

class Receiver {
 public:
  // The referenced objects must outlive the receiver. `lever` is the antenna's position in the
  // body frame, m, and `start` is time 0.
  Receiver(const Constellation& constellation, const VehicleMotion& motion,
           const Eigen::Vector3d& lever, const LocalFrame& frame, Time start, double seconds,
           std::uint64_t seed);

  // Observes at the receiver's own time stamp t (s); epochs are `interval` apart and in order. The
  // scene's bodies must already be at their poses of that time.
  std::vector<ObservedSatellite> observe(double t, double interval, const RayScene& scene);

  // Returns the antenna's reference point without tides; m, ITRF.
  Eigen::Vector3d antenna_ecef(double t) const;

 private:
  struct Tracker {
    std::array<SignalTracker, 2> signals;
    Scatterers scatterers;
    std::array<double, 2> code_bias;  // m, for this receiver and this satellite's code
    double wind_up = 0.0;             // cycles
  };
  // Values that all satellites of an epoch share.
  struct Moment {
    double t, interval, speed;  // s, s, m/s
    SignalPaths around;
    ppp::SunAndMoon bodies;
    Eigen::Vector3d antenna;     // m, earth-fixed, with tides
    Eigen::Vector3d tide;        // m, earth-fixed
    Eigen::Matrix3d R_enu_ecef;  // at the antenna
    Eigen::Matrix3d axes;        // rows: right, forward and up of the car, earth-fixed
  };
  struct Range {
    double metres;  // including both clocks' offsets
    Eigen::Vector3d satellite;
  };

  double clock(double t) const;
  Range range(std::size_t satellite, double t, const Eigen::Vector3d& tide) const;
  ObservedSatellite observe(std::size_t satellite, const Moment& now);

  const Constellation& constellation_;
  const VehicleMotion& motion_;
  Eigen::Vector3d lever_;
  LocalFrame frame_;
  ppp::GpsTime start_;
  ppp::Earth earth_;
  Troposphere troposphere_;
  Ionosphere ionosphere_;
  std::array<ReceiveAntenna, 2> antenna_;
  std::array<Eigen::Vector3d, 2> code_pattern_;  // m, rad, rad: code delay by direction
  std::vector<double> clock_;      // s, one value each second from 2 s before the start
  std::vector<Tracker> trackers_;  // one for each satellite
};

}  // namespace maploop::simulate
