// A run of the PPP filter over files.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "msgs/named_enum.h"
#include "ppp/ppp_setup.h"
#include "tools/ppp/map_loop.h"

namespace maploop::gnss {

// The order of time in which the filter takes the epochs; smoothed: both ways (ppp/smoothing.h).
enum class Direction : std::uint8_t { forward, backward, smoothed };

constexpr auto names_of(Direction) {
  return names_up_to<Direction::smoothed>({"forward", "backward", "smoothed"});
}

struct RunOptions : ppp::SetupOptions {
  std::optional<ppp::GpsTime> start, end;
  Direction direction = Direction::forward;
  std::optional<MapOptions> map;                               // only forward
  std::vector<std::pair<ppp::GpsTime, ppp::GpsTime>> outages;  // begins and ends; without epochs
  std::function<void(ppp::Epoch&)> change;  // where it is set, what happens to each epoch before
};

class PppRun {
 public:
  // Throws as PppSetup; the files must outlive the run.
  PppRun(const ppp::GnssFiles& files, const RunOptions& options);

  // Calls the sink for every epoch between start and end, in the order of time.
  void process(const std::function<void(const ppp::PppSolution&)>& sink);

  // The sink may call these three for the epoch that it is given. filter() is the filter that runs
  // forward. both_ways() is what a smoothed solution is combined of, forward and backward.
  const MapStep& map_step() const { return step_; }
  const ppp::MapAidedFilter& filter() const { return filter_; }
  const std::array<ppp::PppSolution, 2>& both_ways() const { return both_ways_; }

  Direction direction() const { return options_.direction; }
  const ppp::PppSetup& setup() const { return setup_; }
  std::size_t epoch_count() const;  // of those that process() solves
  // Why satellites had no orbit or clock, with the number of epochs.
  std::vector<std::string> missing_products() const;
  double seconds() const { return seconds_; }  // spent in the filter

 private:
  // Between start and end, and in no outage.
  bool is_chosen(const ppp::Epoch& epoch) const;
  // Returns these epochs in the order of time, changed as the options say.
  std::vector<ppp::Epoch> chosen_epochs() const;
  std::vector<ppp::PppSolution> run_backward(const std::vector<ppp::Epoch>& epochs);
  const ppp::PppSolution& step(ppp::MapAidedFilter& filter, const ppp::Epoch& epoch);
  void count_missing(const ppp::PppSolution& solution);

  RunOptions options_;
  ppp::PppSetup setup_;
  ppp::MapAidedFilter filter_;
  std::optional<MapLoop> map_;
  MapStep step_;
  std::array<ppp::PppSolution, 2> both_ways_;
  std::map<ppp::Satellite, std::pair<int, std::string>> missing_;
  double seconds_ = 0.0;
};

}  // namespace maploop::gnss
