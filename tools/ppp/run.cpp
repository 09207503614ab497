#include "tools/ppp/run.h"

#include <algorithm>
#include <chrono>

namespace maploop::gnss {

using namespace maploop::ppp;

PppRun::PppRun(const GnssFiles& files, const RunOptions& options)
    : options_(options), setup_(files, options), filter_(setup_.make_map_aided_filter()) {
  if (options.map) map_.emplace(*options.map);
}

void PppRun::process(const std::function<void(const PppSolution&)>& sink) {
  for (const Epoch& epoch : setup_.observations().epochs) {
    if (options_.start && epoch.time < *options_.start) continue;
    if (options_.end && epoch.time > *options_.end) break;
    const bool lost =
        std::any_of(options_.outages.begin(), options_.outages.end(),
                    [&](const auto& o) { return epoch.time >= o.first && epoch.time < o.second; });
    if (lost) continue;
    const auto begin = std::chrono::steady_clock::now();
    const PppSolution* solution = nullptr;
    if (options_.change) {
      Epoch changed = epoch;
      options_.change(changed);
      solution = &filter_.process(changed);
    } else {
      solution = &filter_.process(epoch);
    }
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    for (const SatelliteReport& s : solution->satellites) {
      if (s.refused == PppRefusal::no_ephemeris) {
        auto& [count, why] = missing_[s.satellite];
        if (count++ == 0) why = setup_.ephemeris().missing(s.satellite, epoch.time);
      }
    }
    step_ = map_ ? map_->close(filter_) : MapStep{};
    sink(*solution);
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
