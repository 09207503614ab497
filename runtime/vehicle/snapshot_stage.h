// The snapshot thread: joins what the stages saved at one cut, and hands it over.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "runtime/core/doorbell.h"
#include "runtime/core/edge.h"
#include "runtime/vehicle/snapshot.h"
#include "runtime/vehicle/thread_meter.h"

namespace maploop::vehicle {

// Called on the snapshot thread, which may take its time: to write a file, for example.
using SnapshotHandler = std::function<void(const Snapshot&)>;

// Bytes to map beforehand for each part.
struct PartSizes {
  std::size_t stereo = 0;
  std::optional<std::size_t> lidar;  // nothing: there is no such part
  std::optional<std::size_t> ppp;
  std::size_t fusion = 0;
  std::optional<std::size_t> mapmatch;
};

// The edges that end at the snapshot thread.
struct SnapshotEdges {
  explicit SnapshotEdges(const PartSizes& bytes);

  runtime::Doorbell bell;
  runtime::Edge<StageSnapshot> stereo;
  std::optional<runtime::Edge<StageSnapshot>> lidar;
  std::optional<runtime::Edge<StageSnapshot>> ppp;
  runtime::Edge<StageSnapshot> fusion;
  std::optional<runtime::Edge<StageSnapshot>> mapmatch;
};

class SnapshotStage {
 public:
  SnapshotStage(const PartSizes& bytes, SnapshotHandler handler);

  SnapshotEdges& edges() { return edges_; }

  // Until all edges are finished and empty; a cut that not every stage reached is dropped. What the
  // handler throws is thrown at the end: the stages must not be held up. `first`: Snapshot's.
  void run(Time first);
  // It takes nothing more, also after a failure.
  void finish();

  const ThreadMeter& meter() const { return meter_; }  // of the handler

 private:
  Snapshot joined(Time first);
  SnapshotEdges edges_;
  std::vector<runtime::Edge<StageSnapshot>*> parts_;
  SnapshotHandler handler_;
  ThreadMeter meter_;
};

}  // namespace maploop::vehicle
