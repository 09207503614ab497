#include "mapmatch/rule_inputs.h"

#include <algorithm>
#include <cmath>

#include "msgs/frames.h"

namespace maploop::mapmatch {
namespace {

constexpr double unreachable = 300.0;  // m
constexpr double u_turn = radians(125.0);
constexpr double near_end = 30.0;  // m before a junction, within which beta is used

double angle_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
}

void set_azimuth_error(const RuleContext& c, MatchCandidate& candidate) {
  const LinkPoint point = c.network.at(candidate.link, candidate.along);
  candidate.azimuth_error = std::abs(wrap_angle(c.motion.azimuth - point.azimuth()));
}

// The rules' distances are meant for fixes with an accuracy of `distance_unit`.
double scaled_distance(const RuleContext& c, const MatchCandidate& candidate) {
  return candidate.distance * c.parameters.distance_unit /
         std::hypot(c.sigma, c.parameters.map_sigma);
}

// Holds the path along the roads from the last matched place to the candidate's, with at most one
// link between them, and whether it is legal.
struct Way {
  double length = 0.0;  // m
  double connectivity = 0.0;
  bool found = false;
};

Way way_to(const RuleContext& c, const MatchCandidate& candidate) {
  Way best;
  const auto offer = [&](double length, double connectivity) {
    if (best.found && connectivity <= best.connectivity) return;
    best = {length, connectivity, true};
  };
  const DirectedLink from = c.last.link;
  if (candidate.link == from) offer(candidate.along - c.last.along, 1.0);
  const double left = c.network.link(from.link).length - c.last.along;
  for (const DirectedLink exit : c.network.exits(c.network.end_junction(from))) {
    const bool legal = c.network.allowed(exit) && c.network.allowed_turn(from, exit);
    if (exit == candidate.link) offer(left + candidate.along, legal ? 1.0 : 0.3);
    if (!legal || exit == from.reversed()) continue;
    for (const DirectedLink second : c.network.exits(c.network.end_junction(exit))) {
      if (second == candidate.link && c.network.allowed(second) &&
          c.network.allowed_turn(exit, second))
        offer(left + c.network.link(exit.link).length + candidate.along, 0.9);
    }
  }
  if (candidate.link == from.reversed())
    offer(std::abs(c.network.link(from.link).length - candidate.along - c.last.along), 0.3);
  return best;
}

template <std::size_t n>
void evaluate(const FuzzySystem& system, RuleBase base, const std::array<double, n>& inputs,
              MatchCandidate& candidate) {
  const FuzzySystem::Result result = system.evaluate(inputs);
  candidate.rules = base;
  candidate.decided = result.decided;
  candidate.likelihood = result.value;
  candidate.weights = result.weights;
}

}  // namespace

void judge_initially(const RuleContext& c, MatchCandidate& candidate) {
  set_azimuth_error(c, candidate);
  evaluate(c.rules.initial, RuleBase::initial,
           std::array{c.motion.speed, degrees(candidate.azimuth_error),
                      scaled_distance(c, candidate), c.hdop},
           candidate);
}

void judge_along(const RuleContext& c, MatchCandidate& candidate) {
  set_azimuth_error(c, candidate);
  candidate.connectivity = 1.0;
  candidate.distance_error = std::abs(candidate.along - c.last.along - c.travelled);
  const double length = c.network.link(candidate.link.link).length;
  double alpha = unknown, beta = unknown;
  if (c.motion.speed >= c.parameters.min_speed) {
    const LinkPoint point = c.network.at(candidate.link, candidate.along);
    if (c.last.has_anchor) alpha = angle_between(point.direction, c.place - c.last.anchor);
    // Further from the junction, the direction to it is not meaningful on a bent road.
    const LinkPoint end = c.network.at(candidate.link, length);
    beta = length - candidate.along > near_end
               ? 0.0
               : angle_between(end.direction, end.position - c.place);
  }
  const double overshoot = c.last.along + c.travelled - length;
  // A U-turn takes several seconds; if there was one, it replaces the turn.
  const double turn = degrees(c.motion.reversal > u_turn ? c.motion.reversal : c.motion.turn);
  const double turn_rate = degrees(c.motion.turn_rate);
  if (std::isfinite(c.motion.visual_turn) && std::isfinite(c.motion.visual_speed)) {
    const double visual_turn = degrees(c.motion.visual_reversal > u_turn ? c.motion.visual_reversal
                                                                         : c.motion.visual_turn);
    evaluate(c.rules.along_visual, RuleBase::along_visual,
             std::array{c.motion.speed, c.hdop, degrees(alpha), degrees(beta), overshoot, turn,
                        turn_rate, c.motion.visual_speed, visual_turn},
             candidate);
  } else {
    evaluate(c.rules.along, RuleBase::along,
             std::array{c.motion.speed, c.hdop, degrees(alpha), degrees(beta), overshoot, turn,
                        turn_rate},
             candidate);
  }
}

void judge_at_junction(const RuleContext& c, MatchCandidate& candidate) {
  set_azimuth_error(c, candidate);
  const Way way = way_to(c, candidate);
  candidate.connectivity = way.found ? way.connectivity : 0.0;
  candidate.distance_error = way.found ? std::abs(way.length - c.travelled) : unreachable;
  evaluate(
      c.rules.junction, RuleBase::junction,
      std::array{c.motion.speed, degrees(candidate.azimuth_error), scaled_distance(c, candidate),
                 c.hdop, candidate.connectivity, candidate.distance_error},
      candidate);
}

}  // namespace maploop::mapmatch
