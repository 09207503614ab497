// What the rule bases are asked, from geometry and motion.
#pragma once

#include "mapmatch/match_parameters.h"
#include "mapmatch/match_result.h"
#include "mapmatch/path_hypothesis.h"
#include "mapmatch/rule_bases.h"
#include "mapmatch/vehicle_motion.h"

namespace maploop::mapmatch {

// The last matched place whose link was sure, where there is one: the fix before's, or, while it is
// open which link behind a junction is the right one, the one before the junction.
struct LastMatch {
  bool there = false;
  DirectedLink link;
  double along = 0.0;  // m
  // A matched point on the same link, far enough behind to take a direction from.
  bool has_anchor = false;
  Eigen::Vector2d anchor = Eigen::Vector2d::Zero();
};

struct RuleContext {
  const RoadNetwork& network;
  const MatchParameters& parameters;
  const RuleBases& rules;
  const Motion& motion;
  Eigen::Vector2d place;  // the fix, m
  double sigma = 0.0;     // m an axis, of the fix
  double hdop = unknown;
  LastMatch last;
  double travelled = 0.0;  // m since then
};

// Fill in what the candidate's link, along and distance lead to: its inputs, the likelihood and the
// weights of the rules.
void judge_initially(const RuleContext& context, MatchCandidate& candidate);
void judge_along(const RuleContext& context, MatchCandidate& candidate);
void judge_at_junction(const RuleContext& context, MatchCandidate& candidate);

}  // namespace maploop::mapmatch
