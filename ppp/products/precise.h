// Interpolates precise orbits (SP3), clocks (RINEX clock, or SP3's own) and attitudes (ORBEX), and
// provides biases of codes and phases.
#pragma once

#include <array>
#include <vector>

#include "ppp/products/ephemeris.h"
#include "ppp/readers/files/bias.h"
#include "ppp/readers/files/clock.h"
#include "ppp/readers/files/orbex.h"
#include "ppp/readers/files/sp3.h"

namespace maploop::ppp {

class PreciseEphemeris : public Ephemeris {
 public:
  // The files come in any order. If two contain the same epoch, the one earlier in the list counts.
  // The clocks of SP3 are used only if there are no clock files.
  PreciseEphemeris(const std::vector<OrbitFile>& orbits, const std::vector<ClockFile>& clocks,
                   const std::vector<BiasFile>& biases);
  // The messages' group delays are used where the files do not tell how the codes of two bands
  // differ. They must outlive this object.
  void use_group_delays(const Ephemeris* messages) { messages_ = messages; }
  // Adds the attitudes of files. Returns how many were left out because the antenna's axis does not
  // point to the earth: they are of another orbit, or the inverse rotation.
  std::size_t use_attitudes(const std::vector<AttitudeFile>& files);

  std::optional<SatelliteState> at(Satellite satellite, GpsTime t) const override;
  std::optional<double> clock(Satellite satellite, GpsTime t) const override;
  double code_bias(Satellite satellite, char band, char attribute, GpsTime t) const override;
  // The biases are those of files, or those that the wide lanes of clock files imply.
  std::optional<double> phase_bias(Satellite satellite, char band, char attribute,
                                   GpsTime t) const override;
  // Returns the error of linear interpolation between clocks that are minutes apart; zero if they
  // are at most a minute apart.
  double error_walk(Satellite satellite) const override;
  std::optional<double> ionosphere_bias(Satellite satellite, GpsTime t) const override;
  std::optional<Eigen::Quaterniond> attitude(Satellite satellite, GpsTime t) const override;
  bool has_phase_biases() const { return has_phase_biases_; }
  bool centre_of_mass() const override { return true; }
  std::string missing(Satellite satellite, GpsTime t) const override;

 private:
  struct OrbitPoint {
    GpsTime time;
    Eigen::Vector3d position;
  };
  std::optional<Eigen::Vector3d> position(Satellite satellite, GpsTime t,
                                          Eigen::Vector3d* velocity) const;

  std::array<std::vector<OrbitPoint>, satellite_slots> orbits_;
  std::array<std::vector<ClockFile::Point>, satellite_slots> clocks_;
  std::array<std::vector<SignalBias>, satellite_slots> biases_;
  std::array<std::vector<ClockFile::WideLane>, satellite_slots> wide_lanes_;
  std::array<std::vector<AttitudeFile::Point>, satellite_slots> attitudes_;
  bool has_phase_biases_ = false;
  const Ephemeris* messages_ = nullptr;
  Duration orbit_interval_{0};
  std::array<double, satellite_slots> clock_walk_{};  // m/sqrt(s)
};

}  // namespace maploop::ppp
