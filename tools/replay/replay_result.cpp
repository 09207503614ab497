#include "tools/replay/replay_result.h"

namespace maploop::tools {

std::uint64_t ReplayResult::samples_lost() const {
  std::uint64_t lost = 0;
  for (const RingHealth& ring : vehicle.health.rings) lost += ring.lost;
  return lost;
}

std::uint64_t ReplayResult::messages_unsent() const {
  std::uint64_t unsent = 0;
  for (const OutputHealth& output : vehicle.health.outputs) unsent += output.unsent;
  return unsent;
}

std::uint64_t ReplayResult::deadline_misses() const {
  std::uint64_t misses = 0;
  for (const LatencySummary& thread : vehicle.deadlines.threads) misses += thread.misses;
  return misses;
}

}  // namespace maploop::tools
