// One stage's side of a snapshot: when to save itself, and whom to give it to.
#pragma once

#include <stop_token>
#include <utility>

#include "runtime/core/data_clock.h"
#include "runtime/core/edge.h"
#include "runtime/vehicle/playback/snapshot.h"
#include "runtime/vehicle/playback/snapshot_moments.h"

namespace maploop::vehicle {

// The stage's own. Saving serializes into the memory of a ring's slot, which is mapped beforehand;
// files are somebody else's work. Without any cut it costs one comparison.
class StageCuts {
 public:
  // Before the run.
  void set(SnapshotMoments moments, runtime::Edge<StageSnapshot>& edge) {
    moments_ = std::move(moments);
    edge_ = &edge;
  }

  // The next cut; Time::max(): there is none.
  Time next() const { return moments_.next(); }

  // Calls save(ArchiveWriter&, cut) for each cut up to t that is still to come. For a stage that
  // has taken all inputs up to each of these cuts, and none after it. Before each, promise(cut): a
  // stage that is far ahead waits here for those behind it, and they must not wait for its outputs.
  template <class Promise, class Save>
  void save_until(Time t, const std::stop_token& stop, Promise&& promise, Save&& save) {
    if (t == Time::max()) moments_.end_period();  // the stage's inputs have ended
    for (Time cut = next(); cut <= t && cut != Time::max(); cut = next()) {
      moments_.pass(cut);
      promise(cut);
      edge_->push(stop, [&](StageSnapshot& slot) {
        slot.stamp = slot.available = cut;
        ArchiveWriter writer(std::move(slot.content));
        save(writer, cut);
        slot.content = writer.take();
      });
      saved_ = runtime::monotonic_now();
    }
  }

  // Of a stage that goes tick by tick and is never far ahead.
  template <class Save>
  void save_until(Time t, const std::stop_token& stop, Save&& save) {
    save_until(
        t, stop, [](Time) {}, std::forward<Save>(save));
  }

  // What kept the stage from a sample released at that moment: being saved, or `otherwise`.
  const char* held_up(MonotonicTime released, const char* otherwise) const {
    return saved_ > released ? "being saved, or waiting for room for it" : otherwise;
  }

  // The stage has ended.
  void finish() {
    if (edge_ != nullptr) edge_->finish();
  }

 private:
  SnapshotMoments moments_;
  runtime::Edge<StageSnapshot>* edge_ = nullptr;
  MonotonicTime saved_{};  // last
};

}  // namespace maploop::vehicle
