#include "runtime/vehicle/playback/snapshot_stage.h"

#include <algorithm>
#include <exception>
#include <iterator>
#include <string>
#include <utility>

#include "runtime/core/data_clock.h"
#include "runtime/vehicle/graph/ring_specs.h"

namespace maploop::vehicle {
namespace {

// Its memory is mapped before the threads run.
StageSnapshot prototype(std::size_t bytes) {
  StageSnapshot prototype;
  prototype.content.resize(bytes);
  return prototype;
}

}  // namespace

SnapshotStage::Part::Part(const GraphStage& saved, runtime::Doorbell* bell)
    : stage(saved.spec().name),
      ring(stage + " -> snapshot", rings::snapshot_capacity, runtime::Overflow::keep_all, bell,
           prototype(saved.saved_bytes())) {}

SnapshotStage::SnapshotStage(const std::vector<std::unique_ptr<GraphStage>>& stages,
                             const SnapshotMoments& cuts, SnapshotHandler handler)
    : handler_(std::move(handler)), meter_(stages::snapshot) {
  for (const auto& stage : stages) {
    parts_.emplace_back(*stage, &bell_);
    stage->save_at(cuts, parts_.back().ring);
  }
}

Snapshot SnapshotStage::joined(Time first) {
  Snapshot snapshot{parts_.front().ring.front()->stamp, first, {}};
  for (Part& part : parts_) snapshot.parts.push_back({part.stage, part.ring.front()->content});
  return snapshot;
}

void SnapshotStage::run(Time first) {
  const auto there = [](Part* part) { return part->ring.front() != nullptr; };
  std::vector<Part*> parts;
  for (Part& part : parts_) parts.push_back(&part);
  std::exception_ptr failure;
  for (;;) {
    const std::uint32_t heard = bell_.listen();
    std::vector<Part*> ended;  // read before the rings: see EdgeBase::promised()
    std::copy_if(parts.begin(), parts.end(), std::back_inserter(ended),
                 [](const Part* part) { return part->ring.promised() == Time::max(); });
    if (std::all_of(parts.begin(), parts.end(), there)) {
      const MonotonicTime started = runtime::monotonic_now();
      try {
        if (!failure) handler_(joined(first));
      } catch (...) {
        failure = std::current_exception();
      }
      meter_.ran(runtime::monotonic_now() - started);
      for (Part* part : parts) part->ring.pop();
    } else if (!std::all_of(ended.begin(), ended.end(), there)) {
      // A stage has ended before this cut: the parts of the other stages are dropped.
      const auto left = std::find_if(parts.begin(), parts.end(), there);
      if (left != parts.end()) {
        (*left)->ring.pop();
      } else if (ended.size() == parts.size()) {
        break;
      } else {
        bell_.wait(heard);
      }
    } else {
      bell_.wait(heard);
    }
  }
  if (failure) std::rethrow_exception(failure);
}

void SnapshotStage::finish() {
  for (Part& part : parts_) part.ring.abandon();
}

std::vector<const runtime::EdgeBase*> SnapshotStage::rings() const {
  std::vector<const runtime::EdgeBase*> rings;
  for (const Part& part : parts_) rings.push_back(&part.ring);
  return rings;
}

}  // namespace maploop::vehicle
