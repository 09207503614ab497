// The range that a receiver at a place should measure to a satellite.
#pragma once

#include "ppp/filter/measurement.h"
#include "ppp/models/antenna.h"
#include "ppp/models/atmosphere.h"
#include "ppp/models/attitude.h"
#include "ppp/models/earth.h"
#include "ppp/models/geodesy.h"
#include "ppp/models/tides.h"
#include "ppp/models/troposphere.h"
#include "ppp/products/ionosphere.h"

namespace maploop::ppp {

// Which models take part; all of them but for measuring what each is worth.
struct Models {
  bool satellite_antenna = true, receiver_antenna = true, wind_up = true;
  bool solid_tide = true, ocean_tide = true, pole_tide = true, shapiro = true;
};

// What the models need besides orbits and clocks. Views: they outlive the filter.
struct Surroundings {
  const Ephemeris* ephemeris = nullptr;
  const std::vector<AntennaFile>* antennas = nullptr;
  const Antenna* receiver = nullptr;  // none: its phase centre is at the reference point
  Eigen::Vector3d marker_to_antenna_enu{0, 0, 0};  // m; the result is the marker's position
  const OceanLoading* ocean_loading = nullptr;
  bool one_frequency = false;                       // may be used, with a model of the ionosphere
  const BroadcastIonosphere* ionosphere = nullptr;  // its coefficients
  std::array<std::optional<int>, 100> glonass_channels{};
  Models models;
};

struct PredictedRange {
  SatelliteState satellite;
  Eigen::Vector3d to_satellite{0, 0, 0};  // unit vector, earth-fixed
  double azimuth = 0.0, elevation = 0.0;  // rad
  double range = 0.0;           // m, everything but receiver clock, wet delay and ambiguity
  double phase_extra = 0.0;     // m, what phase has besides: wind-up
  IonosphericDelay ionosphere;  // m on the first carrier; 0 with two carriers
  double wet_mapping = 0.0;
  bool in_shadow = false;
};

class RangeModel {
 public:
  RangeModel(const Surroundings& surroundings, Earth earth)
      : around_(surroundings), earth_(std::move(earth)) {}

  // Once an epoch, with the best known position of the marker.
  void begin(GpsTime t, const Eigen::Vector3d& marker);
  // Nothing: no orbit or clock. `wind_up_cycles` is that of the satellite's last epoch, and is
  // brought up to date.
  std::optional<PredictedRange> predict(const Measurement& m, double& wind_up_cycles) const;

  const Ephemeris& ephemeris() const { return *around_.ephemeris; }
  const Surroundings& surroundings() const { return around_; }
  const Eigen::Matrix3d& R_enu_ecef() const { return R_enu_ecef_; }
  const ZenithDelay& zenith() const { return zenith_; }  // as predict() takes it

 private:
  Surroundings around_;
  Earth earth_;
  GpsTime time_{};
  Eigen::Vector3d receiver_{0, 0, 0};  // antenna reference point with tides
  Geodetic site_;
  Eigen::Matrix3d R_enu_ecef_ = Eigen::Matrix3d::Identity();
  SunAndMoon bodies_;
  ZenithDelay zenith_;
  GlobalMapping mapping_;
  std::optional<NearestIonosphere> coefficients_;  // of one frequency
};

}  // namespace maploop::ppp
