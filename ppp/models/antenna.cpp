#include "ppp/models/antenna.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace maploop::ppp {
namespace {

double in_row(const std::vector<double>& row, double place) {
  const double p = std::clamp(place, 0.0, static_cast<double>(row.size() - 1));
  const auto i = std::min(row.size() - 1, static_cast<std::size_t>(p));
  const auto k = std::min(row.size() - 1, i + 1);
  return row[i] + (p - static_cast<double>(i)) * (row[k] - row[i]);
}

AssumedAntenna assumed_antenna(const std::vector<const Antenna*>& antennas, System system) {
  AssumedAntenna result;
  for (const char band : bands_of(system)) {
    double sum = 0.0, squares = 0.0;
    int count = 0;
    for (const Antenna* antenna : antennas) {
      if (antenna == nullptr || antenna->satellite->system != system) continue;
      const PhaseCentre* centre = antenna->carrier(system, band);
      if (centre == nullptr) continue;
      sum += centre->offset.z();
      squares += centre->offset.z() * centre->offset.z();
      ++count;
    }
    if (count == 0) continue;
    const double mean = sum / count;
    result.antenna.carriers.push_back({system, band, {0.0, 0.0, mean}, {0.0}, {}});
    result.sigma = std::sqrt(std::max(0.0, squares / count - mean * mean));
  }
  return result;
}

}  // namespace

double phase_variation(const Antenna& antenna, const PhaseCentre& carrier, double zenith,
                       double azimuth) {
  constexpr double to_degrees = 180.0 / std::numbers::pi;
  const double place = (zenith * to_degrees - antenna.zenith_first) / antenna.zenith_step;
  if (carrier.azimuths.empty()) return in_row(carrier.no_azimuth, place);
  double a = std::fmod(azimuth * to_degrees, 360.0);
  if (a < 0.0) a += 360.0;
  a /= antenna.azimuth_step;
  const auto i = std::min(carrier.azimuths.size() - 2, static_cast<std::size_t>(a));
  const double low = in_row(carrier.azimuths[i], place);
  const double high = in_row(carrier.azimuths[i + 1], place);
  return low + (a - static_cast<double>(i)) * (high - low);
}

double receiver_phase_centre(const Antenna& antenna, System system, char band,
                             const Eigen::Vector3d& to_satellite) {
  const PhaseCentre* carrier = antenna.carrier(system, band);
  if (!carrier) {
    const bool upper = band == '1' || (system == System::beidou && band == '2');
    carrier = antenna.carrier(System::gps, upper ? '1' : '2');
  }
  if (!carrier) return 0.0;
  const Eigen::Vector3d offset(carrier->offset.y(), carrier->offset.x(), carrier->offset.z());
  return -offset.dot(to_satellite) +
         phase_variation(antenna, *carrier, std::acos(std::clamp(to_satellite.z(), -1.0, 1.0)),
                         std::atan2(to_satellite.x(), to_satellite.y()));
}

double satellite_phase_centre(const Antenna& antenna, System system, char band,
                              const Eigen::Matrix3d& R_ecef_body,
                              const Eigen::Vector3d& to_receiver) {
  const PhaseCentre* carrier = antenna.carrier(system, band);
  if (!carrier && !antenna.carriers.empty()) carrier = &antenna.carriers.front();
  if (!carrier) return 0.0;
  const Eigen::Vector3d body = R_ecef_body.transpose() * to_receiver;
  return -carrier->offset.dot(body) + phase_variation(antenna, *carrier,
                                                      std::acos(std::clamp(body.z(), -1.0, 1.0)),
                                                      std::atan2(body.x(), body.y()));
}

SatelliteAntennas::SatelliteAntennas(const std::vector<AntennaFile>& files, GpsTime t)
    : own_(satellite_slots) {
  // Those of general files come first, so that a file of satellites only replaces them.
  for (const bool satellites_only : {false, true}) {
    std::vector<const Antenna*> latest(satellite_slots);
    for (const AntennaFile& file : files) {
      if (file.satellites_only != satellites_only) continue;
      for (const Antenna& a : file.antennas) {
        if (!a.satellite || t < a.valid_from) continue;
        const Antenna*& known = latest[a.satellite->slot()];
        if (known == nullptr || a.valid_from > known->valid_from) known = &a;
      }
    }
    for (std::size_t i = 0; i < own_.size(); ++i) {
      if (latest[i] != nullptr) own_[i] = latest[i];
    }
  }
  for (const Antenna*& antenna : own_) {
    if (antenna != nullptr && t >= antenna->valid_until) antenna = nullptr;
  }
  for (int s = 0; s < system_count; ++s)
    assumed_[static_cast<std::size_t>(s)] = assumed_antenna(own_, static_cast<System>(s));
}

const Antenna* receiver_antenna(const std::vector<AntennaFile>& files, const std::string& type,
                                const std::string& radome) {
  if (type.empty()) return nullptr;
  const auto padded = [&](const std::string& dome) {
    std::string name = type;
    name.resize(16, ' ');
    return name + dome;
  };
  for (const std::string& name : {padded(radome), padded("NONE")}) {
    for (const AntennaFile& file : files) {
      for (const Antenna& a : file.antennas) {
        if (!a.satellite && a.type == name) return &a;
      }
    }
  }
  return nullptr;
}

}  // namespace maploop::ppp
