// Files, products and the filter of one receiver, made to fit each other.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ppp/filter/ppp_filter.h"
#include "ppp/gnss_files.h"
#include "ppp/products/broadcast.h"
#include "ppp/products/precise.h"

namespace maploop::ppp {

struct SetupOptions {
  PppParameters parameters;
  Models models;
  bool broadcast = false;  // even where precise orbits are given
};

// Constant after its construction: any number of threads may use it, each with a filter of its own.
// It must outlive these filters, and the files must outlive it.
class PppSetup {
 public:
  // Throws std::runtime_error that names what is missing: no or several observation files, none
  // with an epoch, no orbits.
  PppSetup(const GnssFiles& files, const SetupOptions& options);

  PppFilter make_filter() const;

  const Observations& observations() const { return *observations_; }
  const Ephemeris& ephemeris() const { return *surroundings_.ephemeris; }
  bool precise() const { return precise_ != nullptr; }
  bool one_frequency() const { return one_frequency_; }
  // What models lack: "no calibration of antenna X", one a line.
  const std::vector<std::string>& lacks() const { return lacks_; }

 private:
  void choose_products(const GnssFiles& files, const SetupOptions& options);
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
