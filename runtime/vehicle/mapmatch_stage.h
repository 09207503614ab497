// The mapmatch thread: the fused state on the road map, at a fixed rate.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "mapmatch/feedback.h"
#include "mapmatch/nav_matcher.h"
#include "msgs/map_feedback.h"
#include "msgs/map_match.h"
#include "msgs/nav_state.h"
#include "runtime/core/data_clock.h"
#include "runtime/core/doorbell.h"
#include "runtime/core/edge.h"
#include "runtime/core/intake.h"
#include "runtime/core/periodic.h"
#include "runtime/core/trace_span.h"
#include "runtime/vehicle/fault_delay.h"
#include "runtime/vehicle/road_map.h"
#include "runtime/vehicle/stage_cuts.h"
#include "runtime/vehicle/thread_meter.h"

namespace maploop::vehicle {

// The edges that end at the mapmatch thread.
struct MapMatchEdges {
  MapMatchEdges();

  runtime::Doorbell bell;
  runtime::Edge<NavState> nav_state;
  runtime::Edge<RelativeMotion> visual;
};

class MapMatchStage {
 public:
  // `feedback`: its parameters, where something is fed back; to `feedbacks`.
  MapMatchStage(std::shared_ptr<const RoadMap> map, const mapmatch::MatchParameters& parameters,
                const std::optional<mapmatch::FeedbackParameters>& feedback, MapMatchEdges& inputs,
                std::vector<runtime::Edge<MapMatch>*> matches,
                std::vector<runtime::Edge<MapFeedback>*> feedbacks);

  // Ticks from the first one at or after `first` (data time) until the states are finished or stop
  // is requested. Each matches the newest state that is available by then, and knows the visual
  // odometry that is.
  void run(const runtime::DataClock& clock, Time first, const std::stop_token& stop);
  void finish();

  // Before run().
  void trace_to(runtime::TraceBuffer* buffer) { trace_ = buffer; }
  void slow_down(StageDelay delay) { delay_ = std::move(delay); }
  void save_at(std::vector<Time> moments, runtime::Edge<StageSnapshot>& edge) {
    cuts_.set(std::move(moments), edge);
  }
  // Memory that what it saves takes at most.
  std::size_t saved_bytes() const {
    return sizeof(mapmatch::NavMatcher) + sizeof(mapmatch::Feedback) + 4096;
  }
  // Goes on from what was saved; throws ArchiveError, as NavMatcher.
  void resume(std::span<const std::uint8_t> saved);

  const ThreadMeter& meter() const { return meter_; }  // from the tick's release to its match
  // States so far that were not used for this reason; any thread may ask.
  std::uint64_t count(FixRefusal refusal) const {
    return counts_[static_cast<std::size_t>(refusal)].load(std::memory_order_relaxed);
  }

 private:
  bool tick(const runtime::Tick& tick, const runtime::DataClock& clock,
            const std::stop_token& stop);
  bool wait_until(Time t, const std::stop_token& stop);
  void save_until(Time t, const std::stop_token& stop);
  void promise(Time t);
  template <class Archive, class Stage>
  static void describe(Archive& ar, Stage& stage);

  std::shared_ptr<const RoadMap> map_;
  mapmatch::NavMatcher matcher_;
  std::optional<mapmatch::Feedback> feedback_;
  MapMatchEdges& inputs_;
  std::vector<runtime::Edge<MapMatch>*> matches_;
  std::vector<runtime::Edge<MapFeedback>*> feedbacks_;
  runtime::Intake intake_;
  NavState newest_;
  std::uint64_t ticks_ = 0;
  ThreadMeter meter_;
  StageDelay delay_;
  StageCuts cuts_;
  runtime::TraceBuffer* trace_ = nullptr;
  std::array<std::atomic<std::uint64_t>, fix_refusal_count> counts_{};
};

}  // namespace maploop::vehicle
