// Snapshots along the way, so that a replay can go back.
#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <optional>

#include "runtime/vehicle/snapshot.h"

namespace maploop::vehicle {

// At most `capacity` of them, some 1 MB each: when it is full every second one goes, so that they
// reach over the whole drive, closer together where it was last. Any thread.
class SnapshotRing {
 public:
  explicit SnapshotRing(std::size_t capacity) : capacity_(capacity) {}

  void add(Snapshot snapshot);
  // The last one at or before t.
  std::optional<Snapshot> before(Time t) const;
  std::size_t size() const;

 private:
  std::size_t capacity_;
  mutable std::mutex mutex_;
  std::map<Time, Snapshot> snapshots_;
};

}  // namespace maploop::vehicle
