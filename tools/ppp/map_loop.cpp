#include "tools/ppp/map_loop.h"

#include <stdexcept>

#include "mapmatch/ppp_fix.h"
#include "ppp/epoch_state.h"

namespace maploop::gnss {

MapLoop::MapLoop(const MapOptions& options) : options_(options), window_(options.map) {
  begin_matching();
}

void MapLoop::begin_matching() {
  feedback_.reset();
  matcher_.reset();
  network_ = window_.network();
  matcher_.emplace(*network_, options_.map->rules, options_.match);
  feedback_.emplace(*network_, options_.feedback);
}

MapStep MapLoop::close(ppp::MapAidedFilter& filter) {
  constexpr double any_risk = 1e-4;  // of protection levels, which nobody reads here
  MapStep step;
  ppp::describe(filter.solution(), any_risk, state_);
  if (state_.status == PppStatus::none) return step;
  state_.stamp = ppp::to_utc(filter.solution().time);
  const mapmatch::VehicleFix fix = mapmatch::fix_of(state_);
  if (window_.follow(fix.position)) {
    if (const auto failures = window_.failures(); failures.count > 0)
      throw std::runtime_error(failures.last);
    begin_matching();
  }
  const mapmatch::MatchResult& match = matcher_->add(fix);
  if (match.on_road && match.refusal == FixRefusal::none) {
    step.way_id = matcher_->network().road_at(match.point.vertex).way_id;
    step.probability = match.probability;
  }
  step.feedback = feedback_->decide(match, fix);
  filter.note_road(step.feedback);
  if (options_.tight) step.use = filter.add(step.feedback);
  return step;
}

}  // namespace maploop::gnss
