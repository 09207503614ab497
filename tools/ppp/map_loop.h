// The matcher on the PPP solution, and what goes back to the filter.
#pragma once

#include <optional>

#include "mapmatch/feedback.h"
#include "mapmatch/matcher.h"
#include "msgs/map_feedback.h"
#include "msgs/ppp_state.h"
#include "ppp/filter/map_aided_filter.h"

namespace maploop::gnss {

// Network and rules must outlive who uses them.
struct MapOptions {
  const mapmatch::RoadNetwork* network = nullptr;
  const mapmatch::RuleBases* rules = nullptr;
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
  explicit MapLoop(const MapOptions& options)
      : tight_(options.tight),
        matcher_(*options.network, *options.rules, options.match),
        feedback_(*options.network, options.feedback) {}

  // Of the filter's last epoch.
  MapStep close(ppp::MapAidedFilter& filter);

 private:
  bool tight_;
  mapmatch::Matcher matcher_;
  mapmatch::Feedback feedback_;
  PppState state_;
};

}  // namespace maploop::gnss
