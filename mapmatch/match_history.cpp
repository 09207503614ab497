#include "mapmatch/match_history.h"

#include <algorithm>

namespace maploop::mapmatch {

void MatchHistory::add(const MatchResult& result, const Matcher& matcher) {
  results_.push_back(result);
  if (result.refusal != FixRefusal::none) return;
  const PathFilter& filter = matcher.paths();
  moments_.push_back({results_.size() - 1, paths_.size(), filter.hypotheses().size()});
  for (const PathHypothesis& h : filter.hypotheses()) {
    const PathPoint at = place_on_path(*network_, h, h.s);
    const double length = network_->link(at.link.link).length;
    paths_.push_back({at.link, std::clamp(at.s, 0.0, length), filter.share(h),
                      1.0 - filter.unmapped(h), h.parent});
  }
}

MatchHistory::Weights MatchHistory::shares(const Moment& moment) const {
  Weights weights(moment.count);
  for (std::size_t i = 0; i < moment.count; ++i) weights[i] = paths_[moment.first_path + i].share;
  return weights;
}

// (19) of METHOD.md: a path's weight is that of those which continue it; the weight of paths that
// began at `moment` says nothing of the time before.
MatchHistory::Weights MatchHistory::before(const Moment& moment, const Weights& weights,
                                           const Moment& earlier) const {
  const Weights known = shares(earlier);
  Weights result(earlier.count, 0.0);
  double began = 0.0;
  for (std::size_t i = 0; i < moment.count; ++i) {
    const std::uint32_t parent = paths_[moment.first_path + i].parent;
    (parent < result.size() ? result[parent] : began) += weights[i];
  }
  for (std::size_t i = 0; i < result.size(); ++i) result[i] += began * known[i];
  return result;
}

// (20) of METHOD.md: the vehicle had left the road if P(off road) only rose from here on.
double MatchHistory::off_road(std::size_t moment, std::size_t last) const {
  double most = results_[moments_[moment].result].off_road;
  for (std::size_t k = moment; k <= last; ++k) {
    const double off = results_[moments_[k].result].off_road;
    if (off < may_have_left) break;
    most = std::max(most, off);
  }
  return most;
}

MatchResult MatchHistory::judged(const Moment& moment, const Weights& weights,
                                 double off_road) const {
  MatchResult result = results_[moment.result];
  const auto begin = result.candidates.begin();
  const auto end = begin + static_cast<std::ptrdiff_t>(result.candidate_count);
  std::for_each(begin, end, [](MatchCandidate& c) { c.probability = 0.0; });
  std::array<double, MatchResult::max_candidates> heaviest{};
  for (std::size_t i = 0; i < moment.count; ++i) {
    const Path& path = paths_[moment.first_path + i];
    const auto c =
        std::find_if(begin, end, [&](const MatchCandidate& a) { return a.link == path.link; });
    if (c == end) continue;
    c->probability += weights[i] * path.mapped * (1.0 - off_road);
    double& most = heaviest[static_cast<std::size_t>(c - begin)];
    if (weights[i] > most) {
      most = weights[i];
      c->along = path.along;
    }
  }
  std::stable_sort(begin, end, [](const MatchCandidate& a, const MatchCandidate& b) {
    return a.probability > b.probability;
  });
  result.off_road = off_road;
  result.on_road = result.candidate_count > 0 && off_road < 0.5;
  result.likelihood = result.probability = result.margin = 0.0;
  if (!result.on_road) {
    result.phase = off_road < 0.5 ? MatchPhase::initial : MatchPhase::off_road;
    return result;
  }
  const MatchCandidate& best = result.candidates[0];
  result.phase = MatchPhase::along_link;
  result.link = best.link;
  result.along = best.along;
  result.point = network_->at(best.link, best.along);
  result.likelihood = best.likelihood;
  result.probability = best.probability;
  result.margin =
      best.probability - (result.candidate_count > 1 ? result.candidates[1].probability : 0.0);
  return result;
}

std::vector<MatchResult> MatchHistory::judged_after(Duration lag) const {
  std::vector<MatchResult> results = results_;
  if (paths_.empty()) return results;
  std::size_t last = moments_.size();  // the moment by which `weights` are judged
  Weights weights;
  const auto stamp = [&](std::size_t k) { return results_[moments_[k].result].stamp; };
  for (std::size_t i = moments_.size(); i-- > 0;) {
    std::size_t newest = std::min(last, moments_.size() - 1);
    while (newest > i && stamp(newest) - stamp(i) > lag) --newest;
    // From one fix to the one before, most of the way is the same if the lag has no end.
    std::size_t at = i + 1;
    if (newest != last) {
      last = at = newest;
      weights = shares(moments_[last]);
    }
    for (; at > i; --at) weights = before(moments_[at], weights, moments_[at - 1]);
    results[moments_[i].result] = judged(moments_[i], weights, off_road(i, last));
  }
  return results;
}

}  // namespace maploop::mapmatch
