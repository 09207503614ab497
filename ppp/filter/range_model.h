// Predicts the range that a receiver at a given place should measure to a satellite.
#pragma once

#include <array>

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

// Selects the models in use. All are on, except in experiments that measure the effect of each.
struct Models {
  bool satellite_antenna = true, receiver_antenna = true, wind_up = true;
  bool solid_tide = true, ocean_tide = true, pole_tide = true, shapiro = true;
};

// Contains what the models need besides orbits and clocks. The objects pointed to must outlive the
// filter.
struct RangeInputs {
  const Ephemeris* ephemeris = nullptr;
  const std::vector<AntennaFile>* antennas = nullptr;
  const Antenna* receiver = nullptr;  // nullptr: the phase centre is taken at the reference point
  Eigen::Vector3d marker_to_antenna_enu{0, 0, 0};  // m; the solution is the marker's position
  const OceanLoading* ocean_loading = nullptr;
  const BroadcastIonosphere* ionosphere = nullptr;  // coefficients of its model; nullptr: none
  // Where one of these knows the electrons, the model is not used; the first comes first.
  std::array<const ElectronContent*, 2> electrons{};
  std::array<std::optional<int>, 100> glonass_channels{};
  Models models;
};

struct PredictedRange {
  SatelliteState satellite;
  Eigen::Vector3d to_satellite{0, 0, 0};  // unit vector, earth-fixed
  double azimuth = 0.0, elevation = 0.0;  // rad
  // The range, m, lacks receiver clock, ionosphere, ambiguity, the correction of the wet delay and
  // the antennas, whose share differs between the carriers.
  double range = 0.0;
  std::array<double, 2> antennas{};  // m
  double wind_up = 0.0;              // cycles
  IonosphericDelay ionosphere;       // m on GPS L1
  double ionosphere_slant = 1.0;     // relative to the zenith
  double ionosphere_distance = 0.0;  // of the place that the signal crosses it, 1000 km
  double wet_mapping = 0.0;
  bool in_shadow = false;
  bool calibrated = false;  // the satellite's phase centres are those of its own antenna

  // Returns what a combination of the carriers' codes or phases should be, with the model's
  // ionosphere, m.
  double code(const Measurement& m, Combination c) const;
  double phase(const Measurement& m, Combination c) const;

 private:
  double with_antennas(const std::array<double, 2>& weights) const;
};

class RangeModel {
 public:
  RangeModel(const RangeInputs& inputs, Earth earth) : inputs_(inputs), earth_(std::move(earth)) {}

  // Call once per epoch, with the best known position of the marker (m, earth-fixed).
  void begin(GpsTime t, const Eigen::Vector3d& marker);
  // Returns nothing if there is no orbit or clock. `wind_up_cycles` must be that of the satellite's
  // last epoch and is updated.
  std::optional<PredictedRange> predict(const Measurement& m, double& wind_up_cycles) const;

  const Ephemeris& ephemeris() const { return *inputs_.ephemeris; }
  const RangeInputs& inputs() const { return inputs_; }
  const Eigen::Matrix3d& R_enu_ecef() const { return R_enu_ecef_; }
  const ZenithDelay& zenith() const { return zenith_; }  // the values that predict() uses

 private:
  IonosphericDelay ionosphere(double azimuth, double elevation) const;
  std::optional<SatelliteState> transmitter(const Measurement& m) const;
  void add_phase_centres(const Measurement& m, const Eigen::Matrix3d& attitude,
                         const Eigen::Vector3d& to_satellite_enu, PredictedRange& p) const;

  RangeInputs inputs_;
  std::optional<SatelliteAntennas> antennas_;                            // those of `antennas_day_`
  std::chrono::time_point<GpsClock, std::chrono::days> antennas_day_{};  // they change with a day
  Earth earth_;
  GpsTime time_{};
  Eigen::Vector3d receiver_{0, 0, 0};  // m, earth-fixed: antenna reference point with tides
  Geodetic site_;
  Eigen::Matrix3d R_enu_ecef_ = Eigen::Matrix3d::Identity();
  SunAndMoon bodies_;
  ZenithDelay zenith_;
  GlobalMapping mapping_;
  std::optional<NearestIonosphere> coefficients_;
};

}  // namespace maploop::ppp
