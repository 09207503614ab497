// Combines files, products and filter parameters into the setup of one receiver's PPP filter.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ppp/filter/map_aided_filter.h"
#include "ppp/gnss_files.h"
#include "ppp/heights/height_model.h"
#include "ppp/products/broadcast.h"
#include "ppp/products/corrected.h"
#include "ppp/products/ionosphere_maps.h"
#include "ppp/products/precise.h"

namespace maploop::ppp {

// Holds what is chosen for a setup, besides the files.
struct SetupOptions {
  PppParameters parameters{};  // of the filter
  Models models{};             // which corrections of the ranges are made
  bool broadcast = false;      // uses broadcast orbits even if precise ones are given
  std::string heights{};       // tile or folder of tiles; empty: the ground's height is not used
  std::string geoid{};         // as of HeightModel
};

// A LiveReceiver is one whose stream is read; it describes what the header of a file would give.
struct LiveReceiver {
  bool one_frequency = false;   // it measures on one carrier only
  std::string antenna, radome;  // as named in ANTEX; empty: unknown
};

// A PppSetup is constant after its construction: any number of threads may use it, each with its
// own filter. It must outlive these filters, and the files must outlive it.
class PppSetup {
 public:
  // Throws std::runtime_error that names what is missing or ambiguous: no or several observation
  // files, no epoch in them, no orbits.
  PppSetup(const GnssFiles& files, const SetupOptions& options);

  // Observations come from a receiver, and so do orbits unless the files contain precise ones. The
  // other files are used as in the constructor above.
  PppSetup(const GnssFiles& files, const SetupOptions& options, const LiveReceiver& receiver);

  // Returns a new filter. `received` replaces the orbits, clocks and ionosphere of the files; it
  // must outlive the filter.
  PppFilter make_filter(const CorrectedEphemeris* received = nullptr) const;
  // Does the same for a filter that also uses the road that map matching has found.
  MapAidedFilter make_map_aided_filter(const CorrectedEphemeris* received = nullptr) const;

  // Returns whether the observations come from a receiver instead of a file.
  bool live() const { return observations_ == nullptr; }
  // Returns the observations of the files. Precondition: not live.
  const Observations& observations() const { return *observations_; }
  // Returns the navigation messages of the files; nullptr if there are none and the setup is not
  // live.
  const BroadcastEphemeris* broadcast() const { return broadcast_.get(); }
  // Returns the parameters from the options.
  const PppParameters& parameters() const { return parameters_; }
  // Returns the orbits and clocks that a filter uses, unless it is given received ones.
  const Ephemeris& ephemeris() const { return *inputs_.ephemeris; }
  // Returns whether these are precise products.
  bool precise() const { return precise_ != nullptr; }
  // Returns whether they contain the biases of phases, which integers need.
  bool phase_biases() const { return precise() && precise_->has_phase_biases(); }
  // Returns how far the ionosphere's nearest coefficients are from a moment, 0 where electrons are
  // known; nothing if there are none. `received` is that of the filter.
  std::optional<Duration> age_of_ionosphere(GpsTime t,
                                            const CorrectedEphemeris* received = nullptr) const;
  // Returns whether the receiver measures most satellites on one carrier only.
  bool one_frequency() const { return one_frequency_; }
  // On one frequency, the errors of broadcast orbits, clocks and ionosphere last longer than the
  // filter can average them out: decimetres of error remain, between houses metres.
  bool never_converges() const { return one_frequency_ && !precise() && !live(); }
  // Lists what the models lack, such as "no calibration of antenna X".
  const std::vector<std::string>& missing_models() const { return missing_models_; }
  // Returns nullptr without heights.
  const HeightModel* heights() const { return heights_.get(); }

 private:
  void choose_products(const GnssFiles& files, const SetupOptions& options);
  void fill_inputs(const GnssFiles& files, const SetupOptions& options,
                   const ObservationHeader& header);
  void choose_ionosphere(const GnssFiles& files);
  void read_heights(const SetupOptions& options);
  void note_lacks_of_integers(const GnssFiles& files);

  PppParameters parameters_;
  const Observations* observations_ = nullptr;
  std::unique_ptr<BroadcastEphemeris> broadcast_;
  std::unique_ptr<PreciseEphemeris> precise_;
  std::unique_ptr<IonosphereMaps> ionosphere_maps_;
  RangeInputs inputs_;
  std::unique_ptr<HeightModel> heights_;
  Earth earth_;
  std::vector<std::string> missing_models_;
  bool one_frequency_ = false;
};

}  // namespace maploop::ppp
