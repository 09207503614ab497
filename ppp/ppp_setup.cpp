#include "ppp/ppp_setup.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace maploop::ppp {
namespace {

const Observations& only_observations(const GnssFiles& files) {
  if (files.observations.size() != 1) {
    throw std::runtime_error(std::to_string(files.observations.size()) +
                             " observation files among the files given: give one");
  }
  const Observations& observations = files.observations.front();
  if (observations.epochs.empty()) throw std::runtime_error(observations.file + ": has no epoch");
  return observations;
}

// Whether most satellites have only one of the two carriers.
bool has_one_frequency(const Observations& o) {
  std::size_t one = 0, two = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(o.epochs.size(), 20); ++i) {
    for (const auto& s : o.epochs[i].satellites) {
      const auto bands = bands_of(s.satellite.system);
      const auto signals = o.epochs[i].of(s);
      const auto has = [&](char band) {
        return std::any_of(signals.begin(), signals.end(),
                           [band](const Signal& signal) { return signal.band == band; });
      };
      (has(bands[0]) && has(bands[1]) ? two : one) += 1;
    }
  }
  return one > 2 * two;
}

}  // namespace

PppSetup::PppSetup(const GnssFiles& files, const SetupOptions& options)
    : parameters_(options.parameters),
      observations_(&only_observations(files)),
      earth_(files.earth_rotation) {
  choose_products(files, options);
  const ObservationHeader& header = observations_->header;
  surroundings_.antennas = &files.antennas;
  surroundings_.marker_to_antenna_enu = header.antenna_delta_enu;
  surroundings_.glonass_channels = header.glonass_channels;
  if (broadcast_) {
    const auto channels = broadcast_->glonass_channels();
    for (std::size_t n = 0; n < channels.size(); ++n) {
      if (channels[n]) surroundings_.glonass_channels[n] = channels[n];
    }
  }
  surroundings_.models = options.models;
  surroundings_.receiver = receiver_antenna(files.antennas, header.antenna, header.radome);
  if (!surroundings_.receiver) {
    lacks_.push_back("no calibration of the receiver's antenna '" + header.antenna + ' ' +
                     header.radome + "': its phase centre is taken to be its reference point");
  }
  if (precise() && files.antennas.empty()) {
    lacks_.push_back(
        "no ANTEX file: satellites' phase centres are taken to be their centres of mass");
  }
  if (header.approximate_position) {
    surroundings_.ocean_loading =
        nearest_station(files.ocean_loading, *header.approximate_position, header.marker);
  }
  one_frequency_ = has_one_frequency(*observations_);
  if (one_frequency_) choose_ionosphere();
}

void PppSetup::choose_products(const GnssFiles& files, const SetupOptions& options) {
  if (!files.navigation.empty()) {
    broadcast_ = std::make_unique<BroadcastEphemeris>(files.navigation);
  }
  if (!files.orbits.empty() && !options.broadcast) {
    precise_ = std::make_unique<PreciseEphemeris>(files.orbits, files.clocks, files.biases);
    surroundings_.ephemeris = precise_.get();
  } else if (broadcast_) {
    surroundings_.ephemeris = broadcast_.get();
  } else {
    throw std::runtime_error("no orbits: give an SP3 file with clocks, or a navigation file");
  }
}

void PppSetup::choose_ionosphere() {
  parameters_ = for_one_frequency(parameters_);
  if (broadcast_ && broadcast_->klobuchar()) {
    surroundings_.klobuchar = &*broadcast_->klobuchar();
    return;
  }
  static constexpr std::array<double, 8> typical{1.1e-8, 1.5e-8, -6e-8,  -6e-8,
                                                 8.8e4,  1.6e4,  -1.3e5, -6.6e4};
  surroundings_.klobuchar = &typical;
  lacks_.push_back("no ionospheric coefficients in a navigation file: typical ones are used");
}

PppFilter PppSetup::make_filter() const {
  return {parameters_, surroundings_, earth_};
}

}  // namespace maploop::ppp
