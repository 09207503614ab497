// The matcher on the PPP solution, and what goes back to the filter.
#pragma once

#include <memory>
#include <optional>

#include "mapmatch/feedback.h"
#include "mapmatch/matcher.h"
#include "msgs/map_feedback.h"
#include "msgs/ppp_state.h"
#include "ppp/filter/map_aided_filter.h"
#include "runtime/vehicle/stages/map_window.h"

namespace maploop::gnss {

struct MapOptions {
  std::shared_ptr<const vehicle::RoadMap> map;
  mapmatch::MatchParameters match;
  mapmatch::FeedbackParameters feedback;
  bool tight = true;  // else matched only
};

// What the map said of an epoch.
struct MapStep {
  std::optional<std::int64_t> way_id;  // matched
  double probability = 0.0;
  MapFeedback feedback;
  ppp::MapUse use = ppp::MapUse::nothing_fed_back;
};

class MapLoop {
 public:
  explicit MapLoop(const MapOptions& options);

  // Of the filter's last epoch.
  MapStep close(ppp::MapAidedFilter& filter);

 private:
  void begin_matching();

  MapOptions options_;
  vehicle::MapWindow window_;
  std::shared_ptr<const mapmatch::RoadNetwork> network_;  // to which the next two refer
  std::optional<mapmatch::Matcher> matcher_;
  std::optional<mapmatch::Feedback> feedback_;
  PppState state_;
};

}  // namespace maploop::gnss
