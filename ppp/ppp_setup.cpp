#include "ppp/ppp_setup.h"

#include <algorithm>
#include <set>
#include <stdexcept>

namespace maploop::ppp {
namespace {

const Observations& only_observations(const GnssFiles& files) {
  if (files.observations.size() != 1) {
    throw std::runtime_error(
        std::to_string(files.observations.size()) +
        " of the given files contain observations: give exactly one such file");
  }
  const Observations& observations = files.observations.front();
  if (observations.epochs.empty())
    throw std::runtime_error(observations.file + ": contains no epochs");
  return observations;
}

// Returns whether most satellites have only one of the two carriers: more than twice as many as
// have both, in the first 20 epochs.
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

std::set<Satellite> satellites_of(const std::vector<OrbitFile>& orbits) {
  std::set<Satellite> satellites;
  for (const OrbitFile& file : orbits) {
    for (const auto& [satellite, points] : file.points) satellites.insert(satellite);
  }
  return satellites;
}

// Returns the first epoch of the last file. Where there are also files of the days before and
// after, the observations are near it.
GpsTime first_time(const std::vector<OrbitFile>& orbits) {
  return orbits.empty() || orbits.back().epochs.empty() ? GpsTime{} : orbits.back().epochs.front();
}

}  // namespace

PppSetup::PppSetup(const GnssFiles& files, const SetupOptions& options)
    : parameters_(options.parameters),
      observations_(&only_observations(files)),
      earth_(files.earth_rotation) {
  choose_products(files, options);
  if (inputs_.ephemeris == nullptr) {
    throw std::runtime_error("no orbits: add an SP3 file with clocks, or a navigation file");
  }
  one_frequency_ = has_one_frequency(*observations_);
  fill_inputs(files, options, observations_->header);
}

PppSetup::PppSetup(const GnssFiles& files, const SetupOptions& options,
                   const LiveReceiver& receiver)
    : parameters_(options.parameters), earth_(files.earth_rotation) {
  // A live receiver runs for days: the messages per satellite are limited.
  constexpr std::size_t max_each = 16;
  broadcast_ = std::make_unique<BroadcastEphemeris>(files.navigation, max_each);
  choose_products(files, options);
  if (!inputs_.ephemeris) inputs_.ephemeris = broadcast_.get();
  one_frequency_ = receiver.one_frequency;
  ObservationHeader header;
  header.antenna = receiver.antenna;
  header.radome = receiver.radome;
  fill_inputs(files, options, header);
}

void PppSetup::fill_inputs(const GnssFiles& files, const SetupOptions& options,
                           const ObservationHeader& header) {
  inputs_.antennas = &files.antennas;
  inputs_.marker_to_antenna_enu = header.antenna_delta_enu;
  inputs_.glonass_channels = header.glonass_channels;
  if (broadcast_) {
    for (int n = 0; n < 100; ++n) {
      if (const auto channel = broadcast_->glonass_channel(n)) {
        inputs_.glonass_channels[static_cast<std::size_t>(n)] = channel;
      }
    }
  }
  inputs_.models = options.models;
  inputs_.receiver = receiver_antenna(files.antennas, header.antenna, header.radome);
  if (!inputs_.receiver) {
    missing_models_.push_back("no calibration of the receiver's antenna '" + header.antenna + ' ' +
                              header.radome +
                              "': its phase centre is taken to be its reference point");
  }
  if (precise() && files.antennas.empty()) {
    missing_models_.push_back(
        "no ANTEX file: satellites' phase centres are taken to be their centres of mass");
  }
  if (precise()) note_lacks_of_integers(files);
  if (header.approximate_position) {
    inputs_.ocean_loading =
        nearest_station(files.ocean_loading, *header.approximate_position, header.marker);
  }
  choose_ionosphere(files);
  read_heights(options);
}

// States what keeps ambiguities real numbers, and which of several antennas counts.
void PppSetup::note_lacks_of_integers(const GnssFiles& files) {
  if (!one_frequency_ && parameters_.integers && !phase_biases()) {
    missing_models_.push_back(
        "no biases of phases: ambiguities stay real numbers, and 0.1 m takes 8 minutes in place of "
        "5 (two systems, median); add Bias-SINEX with phases (OSB of L1C, ...), or clocks of "
        "CNES/CLS with wide lanes");
  }
  if (files.antennas.empty()) return;
  const SatelliteAntennas antennas(files.antennas, first_time(files.orbits));
  std::string unknown;
  for (const Satellite satellite : satellites_of(files.orbits)) {
    const bool used = parameters_.systems.find(letter(satellite.system)) != std::string::npos;
    if (used && antennas.of(satellite) == nullptr) unknown += ' ' + to_string(satellite);
  }
  if (!unknown.empty()) {
    missing_models_.push_back(
        "the antennas of these satellites are in no ANTEX file:" + unknown +
        "; a mean height is assumed, and their ambiguities stay real numbers");
  }
  std::string names;
  int count = 0;
  for (const AntennaFile& file : files.antennas) {
    const bool of_satellites =
        std::any_of(file.antennas.begin(), file.antennas.end(),
                    [](const Antenna& a) { return a.satellite.has_value(); });
    if (of_satellites) names += (count++ > 0 ? ", " : "") + file.file;
  }
  if (count > 1) {
    missing_models_.push_back(
        std::to_string(count) + " files contain antennas of satellites (" + names +
        "): a file of satellites only is used, or else the calibration that began last");
  }
}

void PppSetup::choose_products(const GnssFiles& files, const SetupOptions& options) {
  if (!files.navigation.empty() && !broadcast_) {
    broadcast_ = std::make_unique<BroadcastEphemeris>(files.navigation);
  }
  if (!files.orbits.empty() && !options.broadcast) {
    precise_ = std::make_unique<PreciseEphemeris>(files.orbits, files.clocks, files.biases);
    inputs_.ephemeris = precise_.get();
    precise_->use_group_delays(broadcast_.get());
    if (const std::size_t wrong = precise_->use_attitudes(files.attitudes); wrong > 0) {
      missing_models_.push_back(
          std::to_string(wrong) +
          " attitudes of the ORBEX files do not point to the earth: they are not used; give the "
          "file that belongs to the orbits");
    }
  } else if (broadcast_) {
    inputs_.ephemeris = broadcast_.get();
  }
}

void PppSetup::choose_ionosphere(const GnssFiles& files) {
  if (broadcast_) inputs_.ionosphere = &broadcast_->ionosphere();
  if (!files.ionosphere_maps.empty()) {
    ionosphere_maps_ = std::make_unique<IonosphereMaps>(files.ionosphere_maps);
    inputs_.electrons.back() = ionosphere_maps_.get();
  }
  if (live() || !one_frequency_) return;  // the coefficients may still be received
  const GpsTime first = observations_->epochs.front().time;
  const std::string lack = ionosphere_lack(age_of_ionosphere(first));
  if (!lack.empty()) missing_models_.push_back(lack);
}

std::optional<Duration> PppSetup::age_of_ionosphere(GpsTime t,
                                                    const CorrectedEphemeris* received) const {
  if (received != nullptr && received->electrons().covers(t)) return Duration::zero();
  if (ionosphere_maps_ && ionosphere_maps_->covers(t)) return Duration::zero();
  if (received != nullptr) return received->ionosphere().age(t);
  return broadcast_ ? broadcast_->ionosphere().age(t) : std::nullopt;
}

void PppSetup::read_heights(const SetupOptions& options) {
  if (options.heights.empty()) return;
  heights_ = std::make_unique<HeightModel>(options.heights, options.geoid);
  if (heights_->above_ellipsoid()) return;
  missing_models_.push_back(
      std::string(
          "no grid of the geoid: what the ground's heights count from is estimated; install "
          "Debian's proj-data (") +
      HeightModel::usual_geoid + "), or set [ppp] geoid");
}

PppFilter PppSetup::make_filter(const CorrectedEphemeris* received) const {
  RangeInputs inputs = inputs_;
  if (received != nullptr) {
    inputs.ephemeris = received;
    inputs.ionosphere = &received->ionosphere();
    inputs.electrons.front() = &received->electrons();
  }
  return {parameters_, inputs, earth_, heights_.get()};
}

MapAidedFilter PppSetup::make_map_aided_filter(const CorrectedEphemeris* received) const {
  return MapAidedFilter(make_filter(received), parameters_);
}

}  // namespace maploop::ppp
