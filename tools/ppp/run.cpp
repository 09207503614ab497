#include "tools/ppp/run.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace maploop::gnss {

using namespace maploop::ppp;

namespace {

// Whether most satellites have only one of the two carriers.
bool has_one_frequency(const Observations& o) {
  std::size_t one = 0, two = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(o.epochs.size(), 20); ++i) {
    for (const auto& s : o.epochs[i].satellites) {
      const auto bands = bands_of(s.satellite.system);
      bool has[2] = {false, false};
      for (const Signal& signal : o.epochs[i].of(s)) {
        for (int b = 0; b < 2; ++b) {
          if (signal.band == bands[static_cast<std::size_t>(b)]) has[b] = true;
        }
      }
      (has[0] && has[1] ? two : one) += 1;
    }
  }
  return one > 2 * two;
}

// What a receiver with one frequency is worth, which mostly is a cheap one.
PppParameters for_one_frequency(PppParameters p) {
  p.code_sigma = 1.0;
  p.phase_sigma = 0.005;
  p.full_cn0 = 45.0;
  return p;
}

}  // namespace

PppRun::PppRun(const GnssFiles& files, const RunOptions& options) : options_(options) {
  if (files.observations.size() != 1) {
    throw std::runtime_error(std::to_string(files.observations.size()) +
                             " observation files among the files given: give one");
  }
  observations_ = &files.observations.front();
  if (observations_->epochs.empty()) {
    throw std::runtime_error(observations_->file + ": has no epoch");
  }
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
  if (precise_ && files.antennas.empty()) {
    lacks_.push_back(
        "no ANTEX file: satellites' phase centres are taken to be their centres of mass");
  }
  if (header.approximate_position) {
    surroundings_.ocean_loading =
        nearest_station(files.ocean_loading, *header.approximate_position, header.marker);
  }
  one_frequency_ = has_one_frequency(*observations_);
  if (one_frequency_ && broadcast_ && broadcast_->klobuchar()) {
    surroundings_.klobuchar = &*broadcast_->klobuchar();
  } else if (one_frequency_) {
    static constexpr std::array<double, 8> typical{1.1e-8, 1.5e-8, -6e-8,  -6e-8,
                                                   8.8e4,  1.6e4,  -1.3e5, -6.6e4};
    surroundings_.klobuchar = &typical;
    lacks_.push_back("no ionospheric coefficients in a navigation file: typical ones are used");
  }
  if (one_frequency_) options_.parameters = for_one_frequency(options_.parameters);
  filter_ =
      std::make_unique<PppFilter>(options_.parameters, surroundings_, Earth(files.earth_rotation));
}

void PppRun::choose_products(const GnssFiles& files, const RunOptions& options) {
  if (!files.navigation.empty()) {
    broadcast_ = std::make_unique<BroadcastEphemeris>(files.navigation);
  }
  precise_ = !files.orbits.empty() && !options.broadcast;
  if (precise_) {
    precise_ephemeris_ =
        std::make_unique<PreciseEphemeris>(files.orbits, files.clocks, files.biases);
    surroundings_.ephemeris = precise_ephemeris_.get();
  } else if (broadcast_) {
    surroundings_.ephemeris = broadcast_.get();
  } else {
    throw std::runtime_error("no orbits: give an SP3 file with clocks, or a navigation file");
  }
}

void PppRun::process(const std::function<void(const PppSolution&)>& sink) {
  for (const Epoch& epoch : observations_->epochs) {
    if (options_.start && epoch.time < *options_.start) continue;
    if (options_.end && epoch.time > *options_.end) break;
    const auto begin = std::chrono::steady_clock::now();
    const PppSolution& solution = filter_->process(epoch);
    epoch_times_.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    seconds_ += epoch_times_.back();
    for (const SatelliteReport& s : solution.satellites) {
      if (std::string_view(s.refused).starts_with("no orbit or clock")) {
        auto& [count, why] = missing_[s.satellite];
        if (count++ == 0) why = surroundings_.ephemeris->missing(s.satellite, epoch.time);
      }
    }
    sink(solution);
  }
}

std::vector<std::string> PppRun::missing_products() const {
  std::vector<std::string> lines;
  for (const auto& [satellite, entry] : missing_) {
    lines.push_back(entry.second + " (" + std::to_string(entry.first) + " epochs)");
  }
  return lines;
}

}  // namespace maploop::gnss
