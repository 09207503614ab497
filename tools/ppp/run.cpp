#include "tools/ppp/run.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "ppp/smoothing.h"

namespace maploop::gnss {

using namespace maploop::ppp;

PppRun::PppRun(const GnssFiles& files, const RunOptions& options)
    : options_(options), setup_(files, options), filter_(setup_.make_map_aided_filter()) {
  if (options.map) map_.emplace(*options.map);
}

void PppRun::process(const std::function<void(const PppSolution&)>& sink) {
  const std::vector<Epoch> epochs = chosen_epochs();
  std::vector<PppSolution> backward;  // the last epoch first
  if (options_.direction != Direction::forward) backward = run_backward(epochs);
  for (const Epoch& epoch : epochs) {
    PppSolution solution;
    if (options_.direction == Direction::backward) {
      solution = std::move(backward.back());
    } else {
      solution = step(filter_, epoch);
      step_ = map_ ? map_->close(filter_) : MapStep{};
    }
    if (options_.direction == Direction::smoothed) {
      both_ways_ = {std::move(solution), std::move(backward.back())};
      solution = combined(both_ways_[0], both_ways_[1]);
    }
    if (!backward.empty()) backward.pop_back();
    count_missing(solution);
    sink(solution);
  }
}

bool PppRun::is_chosen(const Epoch& epoch) const {
  return !(options_.start && epoch.time < *options_.start) &&
         !(options_.end && epoch.time > *options_.end) &&
         std::ranges::none_of(options_.outages, [&](const auto& outage) {
           return epoch.time >= outage.first && epoch.time < outage.second;
         });
}

std::size_t PppRun::epoch_count() const {
  const auto& all = setup_.observations().epochs;
  return static_cast<std::size_t>(
      std::ranges::count_if(all, [this](const Epoch& epoch) { return is_chosen(epoch); }));
}

std::vector<Epoch> PppRun::chosen_epochs() const {
  std::vector<Epoch> epochs;
  for (const Epoch& epoch : setup_.observations().epochs) {
    if (!is_chosen(epoch)) continue;
    epochs.push_back(epoch);
    if (options_.change) options_.change(epochs.back());
  }
  return epochs;
}

std::vector<PppSolution> PppRun::run_backward(const std::vector<Epoch>& epochs) {
  MapAidedFilter filter = setup_.make_map_aided_filter();
  std::vector<PppSolution> solutions;
  for (const Epoch& epoch : reversed(epochs)) solutions.push_back(step(filter, epoch));
  return solutions;
}

const PppSolution& PppRun::step(MapAidedFilter& filter, const Epoch& epoch) {
  const auto begin = std::chrono::steady_clock::now();
  const PppSolution& solution = filter.process(epoch);
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return solution;
}

void PppRun::count_missing(const PppSolution& solution) {
  for (const SatelliteReport& s : solution.satellites) {
    if (s.refused != PppRefusal::no_ephemeris) continue;
    auto& [count, why] = missing_[s.satellite];
    if (count++ == 0) why = setup_.ephemeris().missing(s.satellite, solution.time);
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
