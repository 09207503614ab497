// A run of the PPP filter over files.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "ppp/filter/ppp_filter.h"
#include "ppp/gnss_files.h"
#include "ppp/products/broadcast.h"
#include "ppp/products/precise.h"

namespace maploop::gnss {

struct RunOptions {
  ppp::PppParameters parameters;
  ppp::Models models;
  std::optional<ppp::GpsTime> start, end;
  bool broadcast = false;  // even where precise orbits are given
};

// Files, products and the filter, made to fit each other.
class PppRun {
 public:
  // Throws std::runtime_error that names what is missing: no or several observation files, no
  // orbits.
  PppRun(const ppp::GnssFiles& files, const RunOptions& options);

  // Every epoch between start and end, in the order of time.
  void process(const std::function<void(const ppp::PppSolution&)>& sink);

  bool precise() const { return precise_; }
  bool one_frequency() const { return one_frequency_; }
  const ppp::Observations& observations() const { return *observations_; }
  // What models lack: "no calibration of antenna X", one a line.
  const std::vector<std::string>& lacks() const { return lacks_; }
  // Why satellites had no orbit or clock, with the number of epochs.
  std::vector<std::string> missing_products() const;
  double seconds() const { return seconds_; }                              // spent in the filter
  const std::vector<double>& epoch_times() const { return epoch_times_; }  // s, each epoch's

 private:
  void choose_products(const ppp::GnssFiles& files, const RunOptions& options);

  RunOptions options_;
  const ppp::Observations* observations_ = nullptr;
  std::unique_ptr<ppp::BroadcastEphemeris> broadcast_;
  std::unique_ptr<ppp::PreciseEphemeris> precise_ephemeris_;
  ppp::Surroundings surroundings_;
  std::unique_ptr<ppp::PppFilter> filter_;
  std::vector<std::string> lacks_;
  std::map<ppp::Satellite, std::pair<int, std::string>> missing_;
  std::vector<double> epoch_times_;
  bool precise_ = false, one_frequency_ = false;
  double seconds_ = 0.0;
};

}  // namespace maploop::gnss
