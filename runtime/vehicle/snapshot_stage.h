// The snapshot thread: joins what the stages saved at one cut, and hands it over.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "runtime/core/doorbell.h"
#include "runtime/core/edge.h"
#include "runtime/vehicle/snapshot.h"
#include "runtime/vehicle/thread_meter.h"

namespace maploop::vehicle {

// Called on the snapshot thread, which may take its time: to write a file, for example.
using SnapshotHandler = std::function<void(const Snapshot&)>;

// The edges that end at the snapshot thread.
struct SnapshotEdges {
  // Bytes to map beforehand for each part.
  SnapshotEdges(std::size_t stereo_bytes, std::size_t fusion_bytes);

  runtime::Doorbell bell;
  runtime::Edge<StageSnapshot> stereo;
  runtime::Edge<StageSnapshot> fusion;
};

class SnapshotStage {
 public:
  SnapshotStage(std::size_t stereo_bytes, std::size_t fusion_bytes, SnapshotHandler handler);

  SnapshotEdges& edges() { return edges_; }

  // Until both edges are finished and empty; a cut that only one stage reached is dropped. What the
  // handler throws is thrown at the end: the stages must not be held up. `first`: Snapshot's.
  void run(Time first);

  const ThreadMeter& meter() const { return meter_; }  // of the handler

 private:
  SnapshotEdges edges_;
  SnapshotHandler handler_;
  ThreadMeter meter_;
};

}  // namespace maploop::vehicle
