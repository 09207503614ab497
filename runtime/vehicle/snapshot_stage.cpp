#include "runtime/vehicle/snapshot_stage.h"

#include <algorithm>
#include <exception>
#include <iterator>
#include <string>
#include <utility>

#include "runtime/core/data_clock.h"
#include "runtime/vehicle/graph.h"

namespace maploop::vehicle {
namespace {

StageSnapshot mapped(std::size_t bytes) {
  StageSnapshot prototype;
  prototype.content.resize(bytes);
  return prototype;
}

runtime::Edge<StageSnapshot> make_mapped_edge(const EdgeSpec& spec, runtime::Doorbell* bell,
                                              std::size_t bytes) {
  return {std::string(spec.name), spec.capacity, spec.overflow, bell, mapped(bytes)};
}

void make_mapped_edge(std::optional<runtime::Edge<StageSnapshot>>& edge, const EdgeSpec& spec,
                      runtime::Doorbell* bell, std::optional<std::size_t> bytes) {
  if (!bytes) return;
  edge.emplace(std::string(spec.name), spec.capacity, spec.overflow, bell, mapped(*bytes));
}

// Of a part that may not be there.
Bytes content_of(std::optional<runtime::Edge<StageSnapshot>>& part) {
  return part ? part->front()->content : Bytes{};
}

}  // namespace

SnapshotEdges::SnapshotEdges(const PartSizes& bytes)
    : stereo(make_mapped_edge(edges::stereo_snapshot, &bell, bytes.stereo)),
      fusion(make_mapped_edge(edges::fusion_snapshot, &bell, bytes.fusion)) {
  make_mapped_edge(lidar, edges::lidar_snapshot, &bell, bytes.lidar);
  make_mapped_edge(ppp, edges::ppp_snapshot, &bell, bytes.ppp);
  make_mapped_edge(mapmatch, edges::mapmatch_snapshot, &bell, bytes.mapmatch);
}

SnapshotStage::SnapshotStage(const PartSizes& bytes, SnapshotHandler handler)
    : edges_(bytes),
      parts_{&edges_.stereo, &edges_.fusion},
      handler_(std::move(handler)),
      meter_(stages::snapshot) {
  for (auto* part : {&edges_.lidar, &edges_.ppp, &edges_.mapmatch}) {
    if (*part) parts_.push_back(&**part);
  }
}

Snapshot SnapshotStage::joined(Time first) {
  const StageSnapshot& fusion = *edges_.fusion.front();
  return {fusion.stamp,
          first,
          edges_.stereo.front()->content,
          content_of(edges_.lidar),
          content_of(edges_.ppp),
          fusion.content,
          content_of(edges_.mapmatch)};
}

void SnapshotStage::run(Time first) {
  using Part = runtime::Edge<StageSnapshot>;
  const auto there = [](Part* part) { return part->front() != nullptr; };
  std::exception_ptr failure;
  for (;;) {
    const std::uint32_t heard = edges_.bell.listen();
    std::vector<Part*> ended;  // read before the rings: see EdgeBase::promised()
    std::copy_if(parts_.begin(), parts_.end(), std::back_inserter(ended),
                 [](const Part* part) { return part->promised() == Time::max(); });
    if (std::all_of(parts_.begin(), parts_.end(), there)) {
      const MonotonicTime started = runtime::monotonic_now();
      try {
        if (!failure) handler_(joined(first));
      } catch (...) {
        failure = std::current_exception();
      }
      meter_.ran(runtime::monotonic_now() - started);
      for (Part* part : parts_) part->pop();
    } else if (!std::all_of(ended.begin(), ended.end(), there)) {
      // A stage has ended before this cut: the others' parts are dropped.
      const auto left = std::find_if(parts_.begin(), parts_.end(), there);
      if (left != parts_.end()) {
        (*left)->pop();
      } else if (ended.size() == parts_.size()) {
        break;
      } else {
        edges_.bell.wait(heard);
      }
    } else {
      edges_.bell.wait(heard);
    }
  }
  if (failure) std::rethrow_exception(failure);
}

void SnapshotStage::finish() {
  for (auto* part : parts_) part->abandon();
}

}  // namespace maploop::vehicle
