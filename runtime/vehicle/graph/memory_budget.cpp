#include "runtime/vehicle/graph/memory_budget.h"

#include <algorithm>
#include <concepts>
#include <tuple>

#include "runtime/vehicle/graph/ring_specs.h"
#include "runtime/vehicle/graph/stage_specs.h"

namespace maploop::vehicle {
namespace {

// Returns the bytes of one sample with its buffers.
template <class T>
std::size_t bytes_of(const SampleSizes& sizes) {
  if constexpr (std::same_as<T, StereoPair>) return sizeof(T) + 2 * sizes.pixels;
  if constexpr (std::same_as<T, LidarScan>) {
    return sizeof(T) + sizes.points * (sizeof(LidarPoint) + sizeof(float));
  }
  return sizeof(T);
}

// Returns the bytes that are mapped for a thread; 0 for one that [scheduling] does not have.
std::size_t stack_of(const StageSpec& stage, const SchedulingParameters& scheduling) {
  const runtime::Scheduling* const found = find_scheduling(scheduling, stage);
  return found != nullptr ? static_cast<std::size_t>(found->prefaulted_stack_kb) * 1024 : 0;
}

void sort_by_bytes(std::vector<MemoryPart>& parts) {
  std::stable_sort(parts.begin(), parts.end(),
                   [](const MemoryPart& a, const MemoryPart& b) { return a.bytes() > b.bytes(); });
}

}  // namespace

std::vector<MemoryPart> memory_budget(const SampleSizes& sizes,
                                      const SchedulingParameters& scheduling) {
  std::vector<MemoryPart> parts, rings;
  for (const StageSpec& stage : stages::all) {
    parts.push_back({std::string(stage.name), 1,
                     stack_of(stage, scheduling) + stage.memory.bytes(sizes.pixels)});
  }
  const auto decodes = [&](const StageSpec& driver, std::size_t each) {
    parts.push_back({std::string(driver.name) + " loader", rings::decoded_ahead, each});
  };
  decodes(stages::camera, bytes_of<StereoPair>(sizes));
  decodes(stages::velodyne, bytes_of<LidarScan>(sizes));
  const auto add = [&]<class T>(const RingSpec<T>& ring) {
    rings.push_back({ring.name(), ring.capacity, bytes_of<T>(sizes)});
  };
  std::apply([&](const auto&... ring) { (add(ring), ...); }, rings::all);
  sort_by_bytes(parts);
  sort_by_bytes(rings);
  parts.insert(parts.end(), rings.begin(), rings.end());
  return parts;
}

}  // namespace maploop::vehicle
