#include "runtime/vehicle/playback/snapshot_ring.h"

#include <iterator>
#include <utility>

namespace maploop::vehicle {

void SnapshotRing::add(Snapshot snapshot) {
  const std::lock_guard lock(mutex_);
  const Time at = snapshot.at;
  if (capacity_ == 0 || snapshots_.contains(at)) return;
  if (snapshots_.size() >= capacity_) {
    bool keep = true;
    std::erase_if(snapshots_, [&keep](const auto&) { return !std::exchange(keep, !keep); });
  }
  if (snapshots_.size() < capacity_) snapshots_.emplace(at, std::move(snapshot));
}

std::optional<Snapshot> SnapshotRing::before(Time t) const {
  const std::lock_guard lock(mutex_);
  const auto after = snapshots_.upper_bound(t);
  if (after == snapshots_.begin()) return std::nullopt;
  return std::prev(after)->second;
}

std::size_t SnapshotRing::size() const {
  const std::lock_guard lock(mutex_);
  return snapshots_.size();
}

}  // namespace maploop::vehicle
