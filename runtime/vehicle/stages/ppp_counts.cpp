#include "runtime/vehicle/stages/ppp_counts.h"

#include <string>
#include <string_view>

#include "runtime/vehicle/graph/stage_specs.h"

namespace maploop::vehicle {

void PppCounts::note(const PppState& state) {
  for (const PppSatellite& s : state.satellites) {
    refused.add(s.refusal);
    slipped.add(s.slip);
  }
  if (state.status == PppStatus::none) without_position.fetch_add(1, std::memory_order_relaxed);
  restarts.store(state.restarts, std::memory_order_relaxed);
}

std::vector<RefusalCount> PppCounts::refusals() const {
  const std::string_view stage = stages::ppp.name;
  std::vector<RefusalCount> all;
  const auto add = [&](std::string_view reason, const std::atomic<std::uint64_t>& number) {
    const std::uint64_t count = number.load(std::memory_order_relaxed);
    if (count > 0) all.push_back({std::string(stage), std::string(reason), count});
  };
  add("epoch without a position", without_position);
  refused.append_to(all, stage);
  slipped.append_to(all, stage, "slip: ");
  heights.append_to(all, stage, "height of the ground: ");
  add("begun anew: measurements disagreed with the position", restarts);
  add("a wrong road forgotten", forgotten_roads);
  add("epoch without corrections", uncorrected);
  add(of_another_time, outdated);
  return all;
}

}  // namespace maploop::vehicle
