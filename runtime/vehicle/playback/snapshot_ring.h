// Keeps snapshots of a replay, so that it can go back.
#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <optional>

#include "runtime/vehicle/playback/snapshot.h"

namespace maploop::vehicle {

// Keeps at most `capacity` snapshots (size: snapshot.h). When it is full, it removes every second
// one, so that they cover the whole drive and are closest together at its end. Any thread may use
// it.
class SnapshotRing {
 public:
  explicit SnapshotRing(std::size_t capacity) : capacity_(capacity) {}

  void add(Snapshot snapshot);
  // Returns the last snapshot at or before t, if there is one.
  std::optional<Snapshot> before(Time t) const;
  std::size_t size() const;

 private:
  std::size_t capacity_;
  mutable std::mutex mutex_;
  std::map<Time, Snapshot> snapshots_;
};

}  // namespace maploop::vehicle
