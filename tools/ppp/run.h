// A run of the PPP filter over files.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ppp/ppp_setup.h"
#include "tools/ppp/map_loop.h"

namespace maploop::gnss {

struct RunOptions : ppp::SetupOptions {
  std::optional<ppp::GpsTime> start, end;
  std::optional<MapOptions> map;
  std::vector<std::pair<ppp::GpsTime, ppp::GpsTime>> outages;  // begins and ends; without epochs
  std::function<void(ppp::Epoch&)> change;  // where it is set, what happens to each epoch before
};

class PppRun {
 public:
  // Throws as PppSetup; the files must outlive the run.
  PppRun(const ppp::GnssFiles& files, const RunOptions& options);

  // Every epoch between start and end, in the order of time.
  void process(const std::function<void(const ppp::PppSolution&)>& sink);

  // Of the epoch that the sink is given.
  const MapStep& map_step() const { return step_; }
  const ppp::MapAidedFilter& filter() const { return filter_; }

  const ppp::PppSetup& setup() const { return setup_; }
  // Why satellites had no orbit or clock, with the number of epochs.
  std::vector<std::string> missing_products() const;
  double seconds() const { return seconds_; }  // spent in the filter

 private:
  RunOptions options_;
  ppp::PppSetup setup_;
  ppp::MapAidedFilter filter_;
  std::optional<MapLoop> map_;
  MapStep step_;
  std::map<ppp::Satellite, std::pair<int, std::string>> missing_;
  double seconds_ = 0.0;
};

}  // namespace maploop::gnss
