// The inputs of the rule bases are computed here from geometry and motion.
#pragma once

#include "mapmatch/match_parameters.h"
#include "mapmatch/match_result.h"
#include "mapmatch/path_hypothesis.h"
#include "mapmatch/rule_bases.h"
#include "mapmatch/vehicle_motion.h"

namespace maploop::mapmatch {

// This is the last matched place with a certain link, if any: that of the previous fix, or, while
// the link after a junction is uncertain, the last one before the junction.
struct LastMatch {
  bool there = false;
  DirectedLink link;
  double along = 0.0;  // m
  // The anchor is a matched point on the same link, far enough behind to define a direction.
  bool has_anchor = false;
  Eigen::Vector2d anchor = Eigen::Vector2d::Zero();
};

struct RuleContext {
  const RoadNetwork& network;
  const MatchParameters& parameters;
  const RuleBases& rules;
  const Motion& motion;
  Eigen::Vector2d place;  // the fix, m
  double sigma = 0.0;     // m, on each axis, of the fix
  double hdop = unknown;
  LastMatch last;
  double travelled = 0.0;  // m, travelled since `last`
};

// These compute the rules' inputs from the candidate's link, along and distance, and fill in its
// inputs, its likelihood and the weights of the rules.
void judge_initially(const RuleContext& context, MatchCandidate& candidate);
void judge_along(const RuleContext& context, MatchCandidate& candidate);
void judge_at_junction(const RuleContext& context, MatchCandidate& candidate);

}  // namespace maploop::mapmatch
