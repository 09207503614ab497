// The snapshot thread: joins what the stages saved at one cut, and hands it over.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "runtime/core/doorbell.h"
#include "runtime/core/edge.h"
#include "runtime/vehicle/graph/graph_stage.h"
#include "runtime/vehicle/health/thread_meter.h"
#include "runtime/vehicle/playback/snapshot.h"
#include "runtime/vehicle/playback/snapshot_moments.h"

namespace maploop::vehicle {

// Called on the snapshot thread, which may take its time: to write a file, for example.
using SnapshotHandler = std::function<void(const Snapshot&)>;

class SnapshotStage {
 public:
  // Makes the stages save themselves at each of these moments, which increase.
  SnapshotStage(const std::vector<std::unique_ptr<GraphStage>>& stages, const SnapshotMoments& cuts,
                SnapshotHandler handler);

  // Runs until all rings are finished and empty; a cut that not every stage reached is dropped. An
  // exception of the handler is thrown at the end, because the stages must not be held up. `first`:
  // Snapshot's.
  void run(Time first);
  // Nothing more is taken, also after a failure.
  void finish();

  std::vector<const runtime::EdgeBase*> rings() const;
  const ThreadMeter& meter() const { return meter_; }  // of the handler

 private:
  struct Part {
    Part(const GraphStage& stage, runtime::Doorbell* bell);
    std::string stage;
    runtime::Edge<StageSnapshot> ring;
  };

  Snapshot joined(Time first);

  runtime::Doorbell bell_;
  std::deque<Part> parts_;
  SnapshotHandler handler_;
  ThreadMeter meter_;
};

}  // namespace maploop::vehicle
