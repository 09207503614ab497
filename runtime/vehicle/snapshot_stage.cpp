#include "runtime/vehicle/snapshot_stage.h"

#include <exception>
#include <string>
#include <utility>

#include "runtime/core/data_clock.h"
#include "runtime/vehicle/graph.h"

namespace maploop::vehicle {
namespace {

runtime::Edge<StageSnapshot> make_mapped_edge(const EdgeSpec& spec, runtime::Doorbell* bell,
                                              std::size_t bytes) {
  StageSnapshot prototype;
  prototype.content.resize(bytes);
  return {std::string(spec.name), spec.capacity, spec.overflow, bell, prototype};
}

}  // namespace

SnapshotEdges::SnapshotEdges(std::size_t stereo_bytes, std::size_t fusion_bytes)
    : stereo(make_mapped_edge(edges::stereo_snapshot, &bell, stereo_bytes)),
      fusion(make_mapped_edge(edges::fusion_snapshot, &bell, fusion_bytes)) {}

SnapshotStage::SnapshotStage(std::size_t stereo_bytes, std::size_t fusion_bytes,
                             SnapshotHandler handler)
    : edges_(stereo_bytes, fusion_bytes), handler_(std::move(handler)), meter_(stages::snapshot) {}

void SnapshotStage::run(Time first) {
  std::exception_ptr failure;
  for (;;) {
    const std::uint32_t heard = edges_.bell.listen();
    const bool stereo_ended = edges_.stereo.promised() == Time::max();
    const bool fusion_ended = edges_.fusion.promised() == Time::max();
    StageSnapshot* stereo = edges_.stereo.front();
    StageSnapshot* fusion = edges_.fusion.front();
    if (stereo != nullptr && fusion != nullptr) {
      const MonotonicTime started = runtime::monotonic_now();
      try {
        if (!failure) handler_({fusion->stamp, first, stereo->content, fusion->content});
      } catch (...) {
        failure = std::current_exception();
      }
      meter_.ran(runtime::monotonic_now() - started);
      edges_.stereo.pop();
      edges_.fusion.pop();
    } else if (stereo != nullptr && fusion_ended) {
      edges_.stereo.pop();
    } else if (fusion != nullptr && stereo_ended) {
      edges_.fusion.pop();
    } else if (stereo_ended && fusion_ended) {
      break;
    } else {
      edges_.bell.wait(heard);
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace maploop::vehicle
