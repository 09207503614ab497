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
#include "runtime/vehicle/stages/map_window.h"
#include "runtime/vehicle/stages/networks_in_use.h"
#include "runtime/vehicle/stages/road_map.h"

namespace maploop::vehicle {

// Each tick matches the newest state that is available by then, with the visual odometry that is
// available by then, sends the feedback if the loop is closed, and what the drive contradicts of
// the map. Over a tiled map, matching begins anew with each window, after the states of the last
// seconds.
class MapMatchStage final : public GraphStage {
 public:
  // `feedback`: its parameters if the map feeds back.
  // `networks`: which roads the matches refer to.
  MapMatchStage(Rings& rings, std::shared_ptr<const RoadMap> map,
                std::shared_ptr<NetworksInUse> networks,
                const mapmatch::MatchParameters& parameters,
                const std::optional<mapmatch::FeedbackParameters>& feedback);

  void run(runtime::DataClock& clock, Time begin, const std::stop_token& stop) override;
  std::size_t saved_bytes() const override {
    return sizeof(Matching) + recent_.capacity() * sizeof(NavState) + 4096;
  }
  std::vector<RefusalCount> refusals() override;

 private:
  // Everything that refers to one road network.
  struct Matching {
    Matching(std::shared_ptr<const mapmatch::RoadNetwork> roads, const mapmatch::RuleBases& rules,
             const mapmatch::MatchParameters& parameters,
             const std::optional<mapmatch::FeedbackParameters>& feedback);

    std::shared_ptr<const mapmatch::RoadNetwork> network;
    mapmatch::NavMatcher matcher;
    mapmatch::DoubtCollector doubts;
    std::optional<mapmatch::Feedback> feedback;
  };

  bool tick(const runtime::Tick& tick, const runtime::DataClock& clock,
            const std::stop_token& stop);
  bool wait_until(Time t, const std::stop_token& stop);
  void save_until(Time t, const std::stop_token& stop);
  void remember(const NavState& state);
  void begin_matching();
  void publish(std::span<const MapDoubt> found, Time available, const std::stop_token& stop);
  void load(ArchiveReader& ar) override { archive(ar); }
  template <class Archive>
  void archive(Archive& ar);

  std::shared_ptr<const RoadMap> map_;
  mapmatch::MatchParameters parameters_;
  std::optional<mapmatch::FeedbackParameters> feedback_parameters_;
  MapWindow window_;
  std::shared_ptr<NetworksInUse> networks_;
  std::unique_ptr<Matching> matching_;
  std::vector<NavState> recent_;  // of a window that moves: the states of the last 10 s
  int since_change_ = 1000;       // ticks since the window changed
  Outputs<MapMatch> matches_;
  Outputs<MapDoubt> doubts_out_;
  Outputs<MapFeedback> feedbacks_;
  runtime::Intake intake_;
  NavState newest_;
  std::uint64_t ticks_ = 0, doubt_count_ = 0;
  ReasonCounts<FixRefusal, count_of<FixRefusal>> counts_;  // of the states
};

}  // namespace maploop::vehicle
