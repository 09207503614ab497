#include "mapmatch/path_filter.h"

#include <algorithm>
#include <cmath>

#include "msgs/frames.h"

namespace maploop::mapmatch {
namespace {

constexpr double birth_interval = 1.0;  // s
constexpr double off_road_low = -6.0;   // log odds are bounded so that they can recover
constexpr double off_road_high = 5.0;
constexpr double turn_misfit = 8.0;  // sigmas squared of azimuth, limit during a turn
constexpr double turning = radians(120.0);
constexpr double most_at_once = 30.0;        // m of evidence, whatever the gap between fixes
constexpr double sure_odds = 2.197;          // log odds of 0.9
constexpr double in_a_turn = radians(20.0);  // within a second

double log_add(double a, double b) {
  const double high = std::max(a, b);
  return high + std::log1p(std::exp(std::min(a, b) - high));
}

}  // namespace

void PathFilter::reset() {
  count_ = 0;
  off_road_ = off_road_low;
  surprise_ = 0.0;
  since_birth_ = 0.0;
}

void PathFilter::step(const PathEvidence& e, const NearLinks& near) {
  // A vehicle that stands stays on its road, whatever the errors of its fixes do meanwhile.
  const double driven = e.motion.speed < PathKalman::standing ? 0.0 : e.motion.interval;
  const double keep = std::exp(-driven / parameters_->memory);
  for (std::size_t i = 0; i < count_; ++i) {
    hypotheses_[i].parent = static_cast<std::uint32_t>(i);
    hypotheses_[i].log_weight *= keep;
    kalman_.predict(hypotheses_[i], e);
  }
  divide(e);
  turn_round(e);
  for (std::size_t i = 0; i < count_; ++i) kalman_.correct(hypotheses_[i], e);
  normalize();
  since_birth_ += driven;
  if (count_ == 0 || since_birth_ >= birth_interval - 1e-3) {
    begin_paths(e, near);
    since_birth_ = 0.0;
    normalize();
  }
  merge();
  normalize();
  judge_road(e);
}

double PathFilter::cost_of(DirectedLink link) const {
  const Road& road = network_->road_at(network_->link(link.link).first_vertex);
  const bool minor = road.restricted || road.road_class == RoadClass::service ||
                     road.road_class == RoadClass::track;
  const double against = network_->doubted(link.link) ? parameters_->doubted_way
                         : network_->allowed(link)    ? 0.0
                                                      : parameters_->wrong_way;
  return against + (minor ? parameters_->minor_road : 0.0);
}

// Near the end of its link a hypothesis divides into one for each exit; past the end, it moves to
// the next link.
void PathFilter::divide(const PathEvidence& e) {
  for (std::size_t i = 0; i < count_; ++i) {
    for (int hops = 0; hops < 8; ++hops) {
      const double length = network_->link(hypotheses_[i].link.link).length;
      const double reach = std::max(parameters_->lookahead, 2.0 * hypotheses_[i].sigma());
      if (!hypotheses_[i].has_next && hypotheses_[i].s > length - reach) take_exits(hypotheses_[i]);
      PathHypothesis& h = hypotheses_[i];
      if (!h.has_next || h.s <= length) break;
      h.previous = h.link;
      h.has_previous = true;
      h.link = h.next;
      h.has_next = false;
      h.turned_round = false;
      h.s -= length;
      kalman_.enter_link(h, e);
    }
  }
}

void PathFilter::take_exits(const PathHypothesis& hypothesis) {
  const PathHypothesis h = hypothesis;
  const auto index = static_cast<std::size_t>(&hypothesis - hypotheses_.data());
  const std::uint32_t junction = network_->end_junction(h.link);
  const auto exits = network_->exits(junction);
  bool first = true;
  // The probability is shared among the exits, not counting the way back if there is another exit.
  const auto ways = static_cast<double>(std::max<std::size_t>(1, exits.size() - 1));
  for (const DirectedLink exit : exits) {
    const bool back = exit == h.link.reversed();
    double cost = cost_of(exit) + std::log(ways);
    if (back) cost += parameters_->turn_round;
    if (!network_->allowed_turn(h.link, exit)) cost += parameters_->banned_turn;
    if (first) {  // replaces the hypothesis itself
      hypotheses_[index].next = exit;
      hypotheses_[index].has_next = true;
      hypotheses_[index].log_weight = h.log_weight - cost;
      first = false;
    } else {
      add_exit(h, exit, cost);
    }
  }
}

void PathFilter::add_exit(const PathHypothesis& h, DirectedLink exit, double cost) {
  PathHypothesis child = h;
  child.next = exit;
  child.has_next = true;
  child.log_weight -= cost;
  add(child);
}

void PathFilter::turn_round(const PathEvidence& e) {
  if (!std::isfinite(e.motion.azimuth) || e.motion.speed < parameters_->min_speed) return;
  const std::size_t before = count_;
  for (std::size_t i = 0; i < before; ++i) {
    PathHypothesis& h = hypotheses_[i];
    if (h.turned_round || std::abs(kalman_.azimuth_error(h, e)) < turning) continue;
    const double length = network_->link(h.link.link).length;
    if (h.s < 0.0 || h.s > length) continue;
    h.turned_round = true;
    PathHypothesis back = h;
    back.link = h.link.reversed();
    back.has_previous = back.has_next = false;
    back.s = length - h.s;
    back.covariance.block<1, 2>(0, 1) *= -1.0;
    back.covariance.block<2, 1>(1, 0) *= -1.0;
    back.log_weight -= parameters_->turn_round + cost_of(back.link);
    add(back);
  }
}

void PathFilter::begin_paths(const PathEvidence& e, const NearLinks& near) {
  const bool start = count_ == 0;
  // Off the road, links are as likely as those that the vehicle left.
  const double cost = start ? 0.0 : parameters_->birth * (1.0 - off_road()) + 1.0 * off_road();
  for (const NearLink& candidate : near.all()) {
    for (const bool forward : {true, false}) {
      PathHypothesis h;
      h.link = {candidate.link.link, forward};
      const double length = network_->link(h.link.link).length;
      h.s = forward ? candidate.along : length - candidate.along;
      if (std::any_of(hypotheses_.begin(), hypotheses_.begin() + static_cast<long>(count_),
                      [&](const PathHypothesis& o) {
                        return o.link == h.link && std::abs(o.s - h.s) < 5.0 + 2.0 * o.sigma();
                      }))
        continue;
      h.trust = start ? parameters_->trust : parameters_->hop_trust;
      h.log_weight = -cost - cost_of(h.link);
      kalman_.begin(h, candidate.point, e);
      if (start || h.log_weight > -parameters_->prune) add(h);
    }
  }
}

// Updates the odds of being off the road, which rise if even the best hypotheses do not fit. Only
// driving shows that, however fast: the evidence is counted over the distance.
void PathFilter::judge_road(const PathEvidence& e) {
  double misfit = count_ == 0 ? 2.0 * parameters_->misfit : 0.0;
  surprise_ = misfit;
  // Vehicles cut corners and U-turns are wide, so a turn alone does not show that the road was
  // left.
  const bool in_turn = e.motion.turn > in_a_turn;
  for (std::size_t i = 0; i < count_; ++i) {
    const PathHypothesis& h = hypotheses_[i];
    const double azimuth_misfit =
        std::min(h.azimuth_misfit, in_turn ? turn_misfit : PathKalman::max_azimuth_misfit);
    misfit += share(h) * (h.offset_misfit + azimuth_misfit);
    surprise_ += share(h) * (h.offset_misfit + std::min(h.azimuth_misfit, turn_misfit));
  }
  // (9) of METHOD.md
  off_road_ += parameters_->off_road_rate * 0.5 * (misfit - parameters_->misfit) *
               std::min(e.motion.distance, most_at_once);
  off_road_ = std::clamp(off_road_, off_road_low, off_road_high);
}

double PathFilter::unmapped(const PathHypothesis& h) const {
  // (10) of METHOD.md
  const double odds = h.trust - parameters_->trust_slope * surprise_;
  // A link with a bad fit is usually still the correct one.
  const double doubt = parameters_->doubt_slope * (sure_odds - odds);
  return 1.0 / (1.0 + std::exp(odds > sure_odds ? odds : sure_odds - doubt));
}

// Merges two hypotheses that have reached the same place and continue in the same way.
void PathFilter::merge() {
  for (std::size_t i = 0; i < count_; ++i) {
    for (std::size_t k = i + 1; k < count_;) {
      PathHypothesis& a = hypotheses_[i];
      PathHypothesis& b = hypotheses_[k];
      const bool same = a.link == b.link && a.has_next == b.has_next &&
                        (!a.has_next || a.next == b.next) &&
                        std::abs(a.s - b.s) < 2.0 + 0.5 * std::min(a.sigma(), b.sigma());
      if (!same) {
        ++k;
        continue;
      }
      const double both = log_add(a.log_weight, b.log_weight);
      if (b.log_weight > a.log_weight) a = b;
      a.log_weight = both;
      b = hypotheses_[--count_];
    }
  }
}

void PathFilter::normalize() {
  if (count_ == 0) return;
  double best = -1e300;
  for (std::size_t i = 0; i < count_; ++i) best = std::max(best, hypotheses_[i].log_weight);
  double sum = 0.0;
  for (std::size_t i = 0; i < count_;) {
    if (hypotheses_[i].log_weight < best - parameters_->prune) {
      hypotheses_[i] = hypotheses_[--count_];
    } else {
      sum += std::exp(hypotheses_[i].log_weight - best);
      ++i;
    }
  }
  // (8) of METHOD.md
  for (std::size_t i = 0; i < count_; ++i) hypotheses_[i].log_weight -= best + std::log(sum);
}

// When full, replaces the least likely hypothesis if `h` is more likely.
void PathFilter::add(const PathHypothesis& h) {
  if (count_ < capacity) {
    hypotheses_[count_++] = h;
    return;
  }
  const auto least =
      std::min_element(hypotheses_.begin(), hypotheses_.end(),
                       [](const auto& a, const auto& b) { return a.log_weight < b.log_weight; });
  if (least->log_weight < h.log_weight) *least = h;
}

}  // namespace maploop::mapmatch
