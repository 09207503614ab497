#include "mapmatch/matcher.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "msgs/frames.h"

namespace maploop::mapmatch {
namespace {

constexpr double region_margin = 12.0;  // m, for the error of the map and half a road's width
constexpr double anchor_step = 2.0;     // m between remembered matched places
constexpr double min_share = 1e-6;      // P of a link without a path hypothesis

}  // namespace

Matcher::Matcher(const RoadNetwork& network, const RuleBases& rules,
                 const MatchParameters& parameters)
    : network_(&network), rules_(&rules), parameters_(parameters), paths_(network, parameters_) {}

FixRefusal Matcher::check(const VehicleFix& fix) {
  const auto& p = fix.position;
  if (!std::isfinite(p.latitude) || !std::isfinite(p.longitude) || !fix.covariance.allFinite() ||
      std::isinf(fix.speed) || std::isinf(fix.azimuth) || std::abs(p.latitude) > radians(90.0) ||
      std::abs(p.longitude) > radians(360.0))
    return FixRefusal::not_finite;
  if (fix.covariance(0, 0) <= 0.0 || fix.covariance(1, 1) <= 0.0 ||
      fix.covariance.determinant() <= 0.0)
    return FixRefusal::bad_covariance;
  return FixRefusal::none;
}

void Matcher::restart() {
  motion_.reset();
  paths_.reset();
  next_anchor_ = 0;
  start_again();
}

// Returns to initial matching.
void Matcher::start_again() {
  last_ = {};
  has_winner_ = false;
  agreed_ = 0.0;
  result_.phase = MatchPhase::initial;
}

const MatchResult& Matcher::add(const VehicleFix& fix) {
  result_.refusal = check(fix);
  if (result_.refusal == FixRefusal::none && started_ && fix.stamp <= result_.stamp)
    result_.refusal = FixRefusal::not_later;
  if (result_.refusal != FixRefusal::none) return result_;
  const Eigen::Vector2d place = network_->to_local(fix.position);
  const double sigma = std::sqrt(0.5 * fix.covariance.trace());
  const bool gap = !started_ || to_seconds(fix.stamp - result_.stamp) > parameters_.max_gap;
  if (gap) gate_.reset();
  const ReachGate::Found found = gate_.judge(fix.stamp, place, sigma);
  if (found == ReachGate::Found::stray) {
    result_.refusal = FixRefusal::out_of_reach;
    return result_;
  }
  if (gap || found == ReachGate::Found::moved) restart();
  started_ = true;
  result_.stamp = fix.stamp;

  const Motion motion = motion_.add(fix, place, parameters_);
  odometer_ += motion.distance;
  travelled_ += motion.distance;
  find_near_links(*network_, place, ErrorEllipse(fix.covariance, region_margin), near_);
  if (parameters_.paths) paths_.step({place, fix.covariance, motion}, near_);

  set_anchor(sigma);
  const RuleContext context{
      *network_,
      parameters_,
      *rules_,
      motion,
      place,
      sigma,
      std::isfinite(fix.hdop) ? fix.hdop : sigma * std::sqrt(2.0) / parameters_.hdop_unit,
      last_,
      travelled_};
  list_candidates(context);
  judge(context);
  const MatchCandidate* chosen = choose();
  if (!chosen && !parameters_.paths && last_.there) {
    // The rules refuse every link behind the last one, so matching starts again with this fix.
    start_again();
    judge(context);
    chosen = choose();
  }
  follow(chosen, motion.interval);
  report(chosen);
  return result_;
}

// Sets the anchor to a matched point on the present link, max(10 m, 3 sigma) behind.
void Matcher::set_anchor(double sigma) {
  last_.has_anchor = false;
  const double baseline = std::max(10.0, 3.0 * sigma);
  const std::size_t known = std::min(next_anchor_, anchor_count);
  for (std::size_t i = 1; i <= known && last_.there; ++i) {
    const Anchor& anchor = anchors_[(next_anchor_ - i) % anchor_count];
    if (!(anchor.link == last_.link)) break;
    if (odometer_ - anchor.odometer < baseline) continue;
    last_.has_anchor = true;
    last_.anchor = anchor.place;
    break;
  }
}

MatchCandidate* Matcher::candidate_of(DirectedLink link) {
  const auto begin = result_.candidates.begin();
  const auto end = begin + static_cast<std::ptrdiff_t>(result_.candidate_count);
  const auto found =
      std::find_if(begin, end, [&](const MatchCandidate& c) { return c.link == link; });
  if (found != end) return &*found;
  if (result_.candidate_count == MatchResult::max_candidates) return nullptr;
  MatchCandidate& added = result_.candidates[result_.candidate_count++];
  added = {};
  added.link = link;
  return &added;
}

// Lists the links of the path hypotheses and those near the fix.
void Matcher::list_candidates(const RuleContext& c) {
  result_.candidate_count = 0;
  const double on_road = 1.0 - paths_.off_road();
  std::array<double, MatchResult::max_candidates> shares{};  // of the likeliest path on each link
  for (const PathHypothesis& h : paths_.hypotheses()) {
    const PathPoint at = place_on_path(*network_, h, h.s);
    MatchCandidate* candidate = candidate_of(at.link);
    if (!candidate) continue;
    const double share =
        on_road * (1.0 - paths_.unmapped(h)) * paths_.share(h);  // (11) of METHOD.md
    double& likeliest = shares[static_cast<std::size_t>(candidate - result_.candidates.data())];
    if (candidate->probability == 0.0 || share > likeliest) {
      candidate->along = std::clamp(at.s, 0.0, network_->link(at.link.link).length);
      likeliest = share;
    }
    candidate->probability += share;
  }
  if (last_.there && !parameters_.paths) candidate_of(last_.link);
  for (const NearLink& n : near_.all()) {
    DirectedLink link = n.link;
    if (network_->allowed(link) && network_->allowed(link.reversed())) {
      const double error = wrap_angle(c.motion.azimuth - n.point.azimuth());
      link.forward = !(std::abs(error) > radians(90.0));
    } else {
      link.forward = network_->allowed(link);
    }
    MatchCandidate* candidate = candidate_of(link);
    if (candidate && candidate->probability == 0.0)
      candidate->along = link.forward ? n.along : network_->link(link.link).length - n.along;
  }
  for (std::size_t i = 0; i < result_.candidate_count; ++i) {
    MatchCandidate& candidate = result_.candidates[i];
    if (candidate.link == last_.link && last_.there && candidate.probability == 0.0 &&
        candidate.along == 0.0) {
      candidate.along =
          std::clamp(last_.along + c.travelled, 0.0, network_->link(candidate.link.link).length);
    }
    const LinkPoint point = network_->at(candidate.link, candidate.along);
    candidate.distance = (point.position - c.place).norm();
    candidate.way_id = network_->road_at(point.vertex).way_id;
    std::tie(candidate.node_a, candidate.node_b) = network_->nodes(candidate.link, point.vertex);
  }
}

void Matcher::judge(const RuleContext& context) {
  for (std::size_t i = 0; i < result_.candidate_count; ++i) {
    MatchCandidate& candidate = result_.candidates[i];
    if (result_.phase == MatchPhase::initial || result_.phase == MatchPhase::off_road ||
        !last_.there) {
      judge_initially(context, candidate);
    } else if (candidate.link == last_.link) {
      judge_along(context, candidate);
    } else {
      judge_at_junction(context, candidate);
    }
  }
}

// Combines the rules' likelihood and the paths' share in one number.
double Matcher::value(const MatchCandidate& candidate) const {
  if (!parameters_.paths) return candidate.likelihood;
  const double likelihood = candidate.decided ? std::max(candidate.likelihood, 10.0) : 50.0;
  // (14) of METHOD.md
  return std::log(std::max(candidate.probability, min_share)) +
         parameters_.fuzzy_weight * std::log(likelihood / 100.0);
}

const MatchCandidate* Matcher::choose() {
  const auto begin = result_.candidates.begin();
  std::sort(begin, begin + static_cast<std::ptrdiff_t>(result_.candidate_count),
            [&](const MatchCandidate& a, const MatchCandidate& b) { return value(a) > value(b); });
  if (result_.candidate_count == 0) return nullptr;
  if (parameters_.paths) return paths_.off_road() > 0.5 ? nullptr : &result_.candidates[0];
  // With the rules alone, the link is left only if they require it.
  const bool subsequent = last_.there && result_.phase != MatchPhase::initial;
  if (!subsequent) return &result_.candidates[0];
  const MatchCandidate* current = candidate_of(last_.link);
  if (current && current->likelihood >= parameters_.stay) return current;
  const MatchCandidate* best = &result_.candidates[0];
  if (best == current && result_.candidate_count > 1) best = &result_.candidates[1];
  return best->likelihood >= parameters_.accept ? best : nullptr;
}

void Matcher::follow(const MatchCandidate* chosen, double interval) {
  const bool established =
      result_.phase == MatchPhase::along_link || result_.phase == MatchPhase::at_junction;
  if (!chosen) {
    start_again();
    if (parameters_.paths && (established || paths_.off_road() > 0.5))
      result_.phase = MatchPhase::off_road;
    return;
  }
  if (established) {
    result_.phase = chosen->link == last_.link ? MatchPhase::along_link : MatchPhase::at_junction;
  } else {
    result_.phase = MatchPhase::initial;
    agreed_ = has_winner_ && winner_ == chosen->link ? agreed_ + interval : 0.0;
    winner_ = chosen->link;
    has_winner_ = true;
    if (agreed_ >= parameters_.agreement) result_.phase = MatchPhase::along_link;
  }
  settle(*chosen);
  const Eigen::Vector2d matched = network_->at(chosen->link, chosen->along).position;
  const Anchor& newest = anchors_[(next_anchor_ + anchor_count - 1) % anchor_count];
  if (next_anchor_ == 0 || !(newest.link == chosen->link) ||
      odometer_ - newest.odometer >= anchor_step) {
    anchors_[next_anchor_ % anchor_count] = {chosen->link, matched, odometer_};
    ++next_anchor_;
  }
}

// While the correct link after a junction is uncertain, all candidates are judged from the link
// before the junction, so that the first choice has no advantage.
void Matcher::settle(const MatchCandidate& chosen) {
  const bool open = parameters_.paths && result_.phase == MatchPhase::at_junction &&
                    margin_of(chosen) < parameters_.sure && travelled_ < parameters_.settle_within;
  if (last_.there && open) return;
  last_.there = true;
  last_.link = chosen.link;
  last_.along = chosen.along;
  travelled_ = 0.0;
}

double Matcher::margin_of(const MatchCandidate& chosen) const {
  double second = 0.0;
  for (std::size_t i = 0; i < result_.candidate_count; ++i) {
    if (!(result_.candidates[i].link == chosen.link))
      second = std::max(second, result_.candidates[i].probability);
  }
  return chosen.probability - second;
}

void Matcher::report(const MatchCandidate* chosen) {
  result_.on_road = chosen != nullptr;
  result_.off_road = parameters_.paths ? paths_.off_road() : 0.0;
  result_.likelihood = result_.probability = result_.margin = 0.0;
  if (!chosen) return;
  result_.link = chosen->link;
  result_.along = chosen->along;
  result_.point = network_->at(chosen->link, chosen->along);
  result_.likelihood = chosen->likelihood;
  result_.probability = chosen->probability;
  result_.margin = margin_of(*chosen);
  double variance = 0.0;
  double best = -1.0;
  for (const PathHypothesis& h : paths_.hypotheses()) {
    if (paths_.share(h) > best && place_on_path(*network_, h, h.s).link == chosen->link) {
      best = paths_.share(h);
      variance = h.covariance(0, 0);
    }
  }
  result_.sigma_along = std::sqrt(variance);
  result_.sigma_across = parameters_.map_sigma;
}

}  // namespace maploop::mapmatch
