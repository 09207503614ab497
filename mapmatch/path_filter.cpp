#include "mapmatch/path_filter.h"

#include <algorithm>
#include <cmath>

#include "msgs/frames.h"

namespace maploop::mapmatch {
namespace {

constexpr double birth_interval = 1.0;  // s
constexpr double off_road_low = -6.0;   // bounds of its log odds: it must be able to come back
constexpr double off_road_high = 5.0;
constexpr double chord = 6.0;      // m before and behind, over which a path's azimuth is taken
constexpr double bend_step = 3.0;  // m before and behind, over which its change is taken
constexpr double max_azimuth_misfit = 16.0;
constexpr double turn_misfit = 8.0;  // of azimuths, as far as any turn can have it
constexpr double edge_cost = 0.3;    // a metre driven beyond the end of a road that leads nowhere
constexpr double turning = radians(120.0);
constexpr double standing = 0.3;     // m/s
constexpr double lost = 9.0;         // sigmas squared along the path, beyond which it tells
constexpr double sure_odds = 2.197;  // log odds of 0.9, below which ...
constexpr double doubt_slope =
    0.15;  // ... a link is doubted less and less (the reliability diagram)
constexpr double in_a_turn = radians(20.0);  // within a second

double log_add(double a, double b) {
  const double high = std::max(a, b);
  return high + std::log1p(std::exp(std::min(a, b) - high));
}

double squared(double x) {
  return x * x;
}

}  // namespace

void PathFilter::reset() {
  count_ = 0;
  off_road_ = off_road_low;
  surprise_ = 0.0;
  since_birth_ = 0.0;
}

void PathFilter::step(const PathEvidence& e, const NearLinks& near) {
  const double keep = std::exp(-e.motion.interval / parameters_->memory);
  for (std::size_t i = 0; i < count_; ++i) {
    hypotheses_[i].log_weight *= keep;
    predict(hypotheses_[i], e);
  }
  divide(e);
  turn_round(e);
  for (std::size_t i = 0; i < count_; ++i) correct(hypotheses_[i], e);
  normalize();
  since_birth_ += e.motion.interval;
  if (count_ == 0 || since_birth_ >= birth_interval - 1e-3) {
    be_born(e, near);
    since_birth_ = 0.0;
    normalize();
  }
  merge();
  normalize();
  judge_road(e);
}

Eigen::Matrix2d PathFilter::slow_covariance(const PathEvidence& e) const {
  return squared(parameters_->map_sigma) * Eigen::Matrix2d::Identity() +
         (1.0 - e.motion.white_share) * e.covariance;
}

Eigen::Matrix2d PathFilter::fast_covariance(const PathEvidence& e) const {
  // The road's own unevenness is one new error a second of driving, however often it is looked at.
  const double repeats = std::max(1.0, 1.0 / std::max(e.motion.interval, 0.01)) *
                         (e.motion.speed < standing ? 10.0 : 1.0);
  return squared(parameters_->road_noise) * repeats * Eigen::Matrix2d::Identity() +
         e.motion.white_share * e.covariance;
}

void PathFilter::predict(PathHypothesis& h, const PathEvidence& e) const {
  const double keep = std::exp(-e.motion.interval / parameters_->correlation_time);
  h.s += e.motion.distance;
  h.offset *= keep;
  h.covariance.block<1, 2>(0, 1) *= keep;
  h.covariance.block<2, 1>(1, 0) *= keep;
  h.covariance.block<2, 2>(1, 1) *= keep * keep;
  h.covariance.block<2, 2>(1, 1) += (1.0 - keep * keep) * slow_covariance(e);
  h.covariance(0, 0) += squared(e.motion.speed_sigma * e.motion.interval) +
                        squared(parameters_->distance_scale * e.motion.distance) + corner_cut(e);
}

// Vehicles cut corners: a turn is shorter than the roads' way round it.
double PathFilter::corner_cut(const PathEvidence& e) const {
  const double turn = std::isfinite(e.motion.turn) ? e.motion.turn : 0.0;
  return squared(parameters_->corner) * turn * std::min(e.motion.interval, 1.0);
}

double PathFilter::cost_of(DirectedLink link) const {
  const Road& road = network_->road_at(network_->link(link.link).first_vertex);
  const bool minor = road.restricted || road.road_class == RoadClass::service ||
                     road.road_class == RoadClass::track;
  return (network_->allowed(link) ? 0.0 : parameters_->wrong_way) +
         (minor ? parameters_->minor_road : 0.0);
}

// Near the end of its link a hypothesis becomes one for each exit; behind it, it is on the next.
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
      enter_link(h, e);
    }
  }
}

// Of the offset, the map's part is another one on another road.
void PathFilter::enter_link(PathHypothesis& h, const PathEvidence& e) const {
  const Eigen::Matrix2d slow = slow_covariance(e);
  const double map = squared(parameters_->map_sigma);
  const double keep = 1.0 - (1.0 - parameters_->link_memory) * map / (0.5 * slow.trace());
  h.offset *= keep;
  h.covariance.block<1, 2>(0, 1) *= keep;
  h.covariance.block<2, 1>(1, 0) *= keep;
  h.covariance.block<2, 2>(1, 1) *= keep * keep;
  h.covariance.block<2, 2>(1, 1) += (1.0 - keep * keep) * slow;
}

void PathFilter::take_exits(const PathHypothesis& hypothesis) {
  const PathHypothesis h = hypothesis;
  const auto index = static_cast<std::size_t>(&hypothesis - hypotheses_.data());
  const std::uint32_t junction = network_->end_junction(h.link);
  const auto exits = network_->exits(junction);
  bool first = true;
  // Of several exits each has a share; the way back is none where there is another.
  const auto ways = static_cast<double>(std::max<std::size_t>(1, exits.size() - 1));
  for (const DirectedLink exit : exits) {
    const bool back = exit == h.link.reversed();
    double cost = cost_of(exit) + std::log(ways);
    if (back) cost += parameters_->turn_round;
    if (!network_->allowed_turn(h.link, exit)) cost += parameters_->banned_turn;
    if (first) {  // takes the place of the hypothesis itself
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
    if (h.turned_round || std::abs(azimuth_error(h, e)) < turning) continue;
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

// The azimuth of the path about a place: a vehicle does not turn on the spot, as its path does.
double PathFilter::azimuth_at(const PathHypothesis& h, double s) const {
  const Eigen::Vector2d along = place_on_path(*network_, h, s + chord).point.position -
                                place_on_path(*network_, h, s - chord).point.position;
  // Where the path turns back, either way may be meant.
  if (along.squaredNorm() < 1.0) return place_on_path(*network_, h, s).point.azimuth();
  return std::atan2(along.x(), along.y());
}

double PathFilter::azimuth_error(const PathHypothesis& h, const PathEvidence& e) const {
  return wrap_angle(e.motion.azimuth - azimuth_at(h, h.s));
}

// The azimuth tells where in a bend or a turn the vehicle is, and whether the path bends as it
// does.
void PathFilter::correct_by_azimuth(PathHypothesis& h, const PathEvidence& e) const {
  const double error = azimuth_error(h, e);
  const double bend = wrap_angle(azimuth_at(h, h.s + bend_step) - azimuth_at(h, h.s - bend_step)) /
                      (2.0 * bend_step);
  const double variance = squared(parameters_->azimuth_noise) + squared(e.motion.azimuth_sigma);
  const double placed =
      squared(bend) * h.covariance(0, 0);  // what the place on the path leaves open
  h.azimuth_misfit = std::min(max_azimuth_misfit, squared(error) / (variance + placed));
  // Its errors change slowly: what a second of them says counts, however often it is told.
  const double weight = parameters_->azimuth_weight * std::min(e.motion.interval, 1.0);
  if (weight <= 0.0) return;
  const double R = variance / weight;
  const double nis = std::min(squared(error) / (placed + R), weight * max_azimuth_misfit);
  h.log_weight -= 0.5 * nis;
  const double S = std::max(placed + R, squared(error) / max_azimuth_misfit);
  const Eigen::Vector3d K = h.covariance.col(0) * bend / S;
  h.s += K.x() * error;
  h.offset += K.tail<2>() * error;
  const Eigen::Matrix3d updated = h.covariance - K * bend * h.covariance.row(0);
  h.covariance = 0.5 * (updated + updated.transpose());
}

void PathFilter::correct(PathHypothesis& h, const PathEvidence& e) const {
  const Eigen::Matrix2d R = fast_covariance(e);
  const double length = network_->link(h.link.link).length;
  // The place on the path that fits best between prediction and fix: the path is bent, and only
  // straight about this place.
  const Eigen::Vector2d target = e.place - h.offset;
  const double fix_variance = 0.5 * (R + h.covariance.block<2, 2>(1, 1)).trace();
  const double path_variance = std::max(h.covariance(0, 0), 0.01);
  const double window = 3.0 * std::sqrt(path_variance) + 3.0;
  double best_cost = 1e300, best_s = h.s;
  PathPoint best;
  double s = h.s - window;
  for (int pieces = 0; pieces < 24 && s < h.s + window; ++pieces) {
    const PathPoint begin = place_on_path(*network_, h, s + 1e-6);
    // To the end of this segment.
    const Link& link = network_->link(begin.link.link);
    const Vertex& a = network_->vertex(begin.point.vertex);
    const Vertex& b = network_->vertex(begin.point.vertex + 1);
    double left = (begin.link.forward ? b.along : link.length - a.along) - begin.s;
    if (left <= 1e-6) left = 2.0 * window;  // on the straight continuation beyond an end
    const double end = std::min(s + left, h.s + window);
    const Eigen::Vector2d& u = begin.point.direction;
    const double projected = s + u.dot(target - begin.point.position);
    const double mean = (projected / fix_variance + h.s / path_variance) /
                        (1.0 / fix_variance + 1.0 / path_variance);
    const double at = std::clamp(mean, s, end);
    const Eigen::Vector2d place = begin.point.position + u * (at - s);
    const double cost =
        squared(at - h.s) / path_variance + (target - place).squaredNorm() / fix_variance;
    if (cost < best_cost) {
      best_cost = cost;
      best_s = at;
      best = begin;
      best.point.position = place;
    }
    s = end + 1e-6;
  }
  const Eigen::Vector2d& u = best.point.direction;
  Eigen::Matrix<double, 2, 3> H;
  H.col(0) = u;
  H.rightCols<2>().setIdentity();
  const Eigen::Vector2d predicted = best.point.position + u * (h.s - best_s) + h.offset;
  const Eigen::Vector2d innovation = e.place - predicted;
  Eigen::Matrix2d S = H * h.covariance * H.transpose() + R;
  double nis = innovation.dot(S.inverse() * innovation);
  if (nis > parameters_->gate) {  // counts as a fix of an accordingly larger error
    S *= nis / parameters_->gate;
    nis = parameters_->gate;
  }
  h.log_weight -=
      parameters_->position_weight * 0.5 * (nis + std::log(std::max(1e-12, S.determinant())));
  const Eigen::Matrix<double, 3, 2> K = h.covariance * H.transpose() * S.inverse();
  const Eigen::Vector3d step = K * innovation;
  h.s += step.x();
  h.offset += step.tail<2>();
  const Eigen::Matrix3d updated = h.covariance - K * H * h.covariance;
  h.covariance = 0.5 * (updated + updated.transpose());

  h.azimuth_misfit = 0.0;
  // How far from the road, of what slow and fast errors allow.
  const Eigen::Vector2d n(u.y(), -u.x());
  const Eigen::Matrix2d slow = slow_covariance(e);
  h.offset_misfit = squared(n.dot(h.offset)) / n.dot(slow * n);
  const Eigen::Vector2d beside = e.place - best.point.position;
  const Eigen::Matrix2d all = slow + e.motion.white_share * e.covariance;
  h.offset_misfit = std::max(h.offset_misfit, squared(n.dot(beside)) / n.dot(all * n));
  // Nor can it be far ahead or behind: who is there has lost the vehicle.
  const double along = squared(u.dot(beside)) / (u.dot(all * u) + h.covariance(0, 0));
  if (along > lost) h.offset_misfit += along;
  if (!network_->allowed(best.link)) h.offset_misfit += parameters_->wrong_way_misfit;
  // An offset that is taken for the map's error costs as long as it is there.
  h.log_weight -=
      parameters_->misfit_rate * 0.5 * h.offset_misfit * std::min(e.motion.interval, 1.0);
  const double beyond = h.s - length;
  if (!h.has_next && beyond > 0.0) h.log_weight -= edge_cost * e.motion.distance;
  if (std::isfinite(e.motion.azimuth) && e.motion.speed > parameters_->min_speed)
    correct_by_azimuth(h, e);
}

void PathFilter::be_born(const PathEvidence& e, const NearLinks& near) {
  const bool start = count_ == 0;
  // Off the road every link is as good as those that the vehicle has left.
  const double cost = start ? 0.0 : parameters_->birth * (1.0 - off_road()) + 1.0 * off_road();
  const Eigen::Matrix2d slow = slow_covariance(e);
  const Eigen::Matrix2d S = slow + fast_covariance(e);
  const Eigen::Matrix2d inverse = S.inverse();
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
      // The fix says where on the link, and how far beside it; the offset is not known apart.
      const Eigen::Vector2d beside = e.place - candidate.point.position;
      h.covariance(0, 0) = candidate.point.direction.dot(S * candidate.point.direction);
      h.covariance.block<2, 2>(1, 1) = slow;
      h.offset = slow * inverse * beside;
      const Eigen::Vector2d u =
          forward ? candidate.point.direction : Eigen::Vector2d(-candidate.point.direction);
      h.covariance.block<1, 2>(0, 1) = -u.transpose() * slow;
      h.covariance.block<2, 1>(1, 0) = -slow * u;
      h.log_weight = -cost - cost_of(h.link) - 0.5 * beside.dot(inverse * beside);
      h.offset_misfit = beside.dot(inverse * beside);
      if (std::isfinite(e.motion.azimuth)) {
        const double variance =
            squared(parameters_->azimuth_noise) + squared(e.motion.azimuth_sigma);
        const double misfit = std::min(max_azimuth_misfit, squared(azimuth_error(h, e)) / variance);
        h.log_weight -= 0.5 * misfit;
        h.azimuth_misfit = misfit;
      }
      if (start || h.log_weight > -parameters_->prune) add(h);
    }
  }
}

// The road is lost where even the best hypothesis does not fit.
void PathFilter::judge_road(const PathEvidence& e) {
  if (e.motion.speed < parameters_->min_speed && e.motion.interval > 0.0 && count_ > 0) return;
  double misfit = count_ == 0 ? 2.0 * parameters_->misfit : 0.0;
  surprise_ = misfit;
  // Corners are cut and U-turns are wide: who turns has not left the road by that alone.
  const bool in_turn = e.motion.turn > in_a_turn;
  for (std::size_t i = 0; i < count_; ++i) {
    const PathHypothesis& h = hypotheses_[i];
    const double azimuth_misfit =
        std::min(h.azimuth_misfit, in_turn ? turn_misfit : max_azimuth_misfit);
    misfit += share(h) * (h.offset_misfit + azimuth_misfit);
    surprise_ += share(h) * (h.offset_misfit + std::min(h.azimuth_misfit, turn_misfit));
  }
  off_road_ += parameters_->off_road_rate * 0.5 * (misfit - parameters_->misfit) *
               std::min(e.motion.interval, 1.0);
  off_road_ = std::clamp(off_road_, off_road_low, off_road_high);
}

double PathFilter::unmapped() const {
  const double odds = parameters_->trust - parameters_->trust_slope * surprise_;
  // Most of what fits badly is the road all the same.
  return 1.0 /
         (1.0 + std::exp(odds > sure_odds ? odds : sure_odds - doubt_slope * (sure_odds - odds)));
}

// Two hypotheses that have come to one place and will go one way are one.
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
  for (std::size_t i = 0; i < count_; ++i) hypotheses_[i].log_weight -= best + std::log(sum);
}

// Where there is no room, the least likely one makes it.
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
