// Files, products and the filter of one receiver, made to fit each other.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ppp/filter/map_aided_filter.h"
#include "ppp/gnss_files.h"
#include "ppp/products/broadcast.h"
#include "ppp/products/corrected.h"
#include "ppp/products/precise.h"

namespace maploop::ppp {

struct SetupOptions {
  PppParameters parameters;
  Models models;
  bool broadcast = false;  // even where precise orbits are given
};

// One that is listened to: what files would say of it.
struct LiveReceiver {
  bool one_frequency = false;
  std::string antenna, radome;  // as ANTEX names them; empty: not known
};

// Constant after its construction: any number of threads may use it, each with a filter of its own.
// It must outlive these filters, and the files must outlive it.
class PppSetup {
 public:
  // Throws std::runtime_error that names what is missing: no or several observation files, none
  // with an epoch, no orbits.
  PppSetup(const GnssFiles& files, const SetupOptions& options);

  // Observations come from a receiver, and orbits too unless the files have precise ones; what else
  // the files have is used as above.
  PppSetup(const GnssFiles& files, const SetupOptions& options, const LiveReceiver& receiver);

  // `received` takes the place of the files' orbits, clocks and ionosphere, and outlives the
  // filter.
  PppFilter make_filter(const CorrectedEphemeris* received = nullptr) const;
  MapAidedFilter make_map_aided_filter(const CorrectedEphemeris* received = nullptr) const;

  bool live() const { return observations_ == nullptr; }
  // Precondition: not live.
  const Observations& observations() const { return *observations_; }
  // Of the files' navigation messages; nullptr: there are none, and no live receiver.
  const BroadcastEphemeris* broadcast() const { return broadcast_.get(); }
  const Ephemeris& ephemeris() const { return *surroundings_.ephemeris; }
  bool precise() const { return precise_ != nullptr; }
  bool one_frequency() const { return one_frequency_; }
  // On one frequency the errors of broadcast orbits, clocks and ionosphere last for longer than the
  // filter can average them: the position stays at metres.
  bool never_converges() const { return one_frequency_ && !precise() && !live(); }
  // What models lack: "no calibration of antenna X", one a line.
  const std::vector<std::string>& lacks() const { return lacks_; }

 private:
  void choose_products(const GnssFiles& files, const SetupOptions& options);
  void look_around(const GnssFiles& files, const SetupOptions& options,
                   const ObservationHeader& header);
  void choose_ionosphere();

  PppParameters parameters_;
  const Observations* observations_ = nullptr;
  std::unique_ptr<BroadcastEphemeris> broadcast_;
  std::unique_ptr<PreciseEphemeris> precise_;
  Surroundings surroundings_;
  Earth earth_;
  std::vector<std::string> lacks_;
  bool one_frequency_ = false;
};

}  // namespace maploop::ppp
