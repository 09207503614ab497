// The mapmatch thread: the fused state on the road map, at a fixed rate.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "mapmatch/doubt_collector.h"
#include "mapmatch/feedback.h"
#include "mapmatch/nav_matcher.h"
#include "msgs/map_doubt.h"
#include "msgs/map_feedback.h"
#include "msgs/map_match.h"
#include "msgs/nav_state.h"
#include "runtime/core/intake.h"
#include "runtime/core/periodic.h"
#include "runtime/vehicle/graph/graph_stage.h"
#include "runtime/vehicle/health/reason_counts.h"
#include "runtime/vehicle/stages/road_map.h"

namespace maploop::vehicle {

// Each tick matches the newest state that is available by then, with the visual odometry that is
// available by then, sends the feedback if the loop is closed, and what the drive contradicts of
// the map.
class MapMatchStage final : public GraphStage {
 public:
  // `feedback`: its parameters if the map feeds back.
  MapMatchStage(Rings& rings, std::shared_ptr<const RoadMap> map,
                const mapmatch::MatchParameters& parameters,
                const std::optional<mapmatch::FeedbackParameters>& feedback);

  void run(runtime::DataClock& clock, Time begin, const std::stop_token& stop) override;
  std::size_t saved_bytes() const override {
    return sizeof(mapmatch::NavMatcher) + sizeof(mapmatch::DoubtCollector) +
           sizeof(mapmatch::Feedback) + 4096;
  }
  std::vector<RefusalCount> refusals() override { return counts_.of(spec().name); }

 private:
  bool tick(const runtime::Tick& tick, const runtime::DataClock& clock,
            const std::stop_token& stop);
  bool wait_until(Time t, const std::stop_token& stop);
  void save_until(Time t, const std::stop_token& stop);
  void publish(std::span<const MapDoubt> found, Time available, const std::stop_token& stop);
  void load(ArchiveReader& ar) override { archive(ar); }
  template <class Archive>
  void archive(Archive& ar);

  std::shared_ptr<const RoadMap> map_;
  mapmatch::NavMatcher matcher_;
  mapmatch::DoubtCollector doubts_;
  std::optional<mapmatch::Feedback> feedback_;
  Outputs<MapMatch> matches_;
  Outputs<MapDoubt> doubts_out_;
  Outputs<MapFeedback> feedbacks_;
  runtime::Intake intake_;
  NavState newest_;
  std::uint64_t ticks_ = 0, doubt_count_ = 0;
  ReasonCounts<FixRefusal, count_of<FixRefusal>> counts_;  // of the states
};

}  // namespace maploop::vehicle
