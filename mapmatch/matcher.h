// The matcher performs fuzzy map matching for each fix: initial matching (IMP), subsequent matching
// along a link (SMP-1) and at a junction (SMP-2), and back. It combines the evidence of path
// hypotheses with the likelihoods of the rules.
//
// Not thread-safe; each thread needs its own matcher. Allocates nothing after construction.
// Decisions depend only on the fixes and their stamps.
#pragma once

#include <array>
#include <cstddef>

#include "mapmatch/candidate_search.h"
#include "mapmatch/match_result.h"
#include "mapmatch/parameter_table.h"
#include "mapmatch/path_filter.h"
#include "mapmatch/reach_gate.h"
#include "mapmatch/rule_bases.h"
#include "mapmatch/rule_inputs.h"
#include "mapmatch/vehicle_motion.h"
#include "msgs/parameter_archive.h"

namespace maploop::mapmatch {

// A Matcher follows one vehicle over the roads of one network.
class Matcher {
 public:
  // The network and the rules must outlive the matcher.
  Matcher(const RoadNetwork& network, const RuleBases& rules, const MatchParameters& parameters);
  Matcher(const Matcher&) = delete;
  Matcher& operator=(const Matcher&) = delete;

  // Takes fixes in the order of their stamps. A fix that cannot be used only changes `refusal` of
  // the result. The result is valid until the next call.
  const MatchResult& add(const VehicleFix& fix);

  // Returns the network that was given to the constructor.
  const RoadNetwork& network() const { return *network_; }
  // Returns the parameters that were given to the constructor.
  const MatchParameters& parameters() const { return parameters_; }
  // Returns the path hypotheses after the last fix; there are none with the rules alone.
  const PathFilter& paths() const { return paths_; }
  // Returns the rules that were given to the constructor.
  const RuleBases& rules() const { return *rules_; }

  // Archives the whole state. Loading refuses an archive of another network or other parameters.
  template <class Archive>
  void archive(Archive& ar);

 private:
  struct Anchor {
    DirectedLink link;
    Eigen::Vector2d place = Eigen::Vector2d::Zero();  // matched position
    double odometer = 0.0;                            // m
    template <class Archive>
    void archive(Archive& ar) {
      ar(link, place, odometer);
    }
  };
  static constexpr std::size_t anchor_count = 64;

  static FixRefusal check(const VehicleFix& fix);
  void restart();
  void start_again();
  void list_candidates(const RuleContext& context);
  MatchCandidate* candidate_of(DirectedLink link);
  void judge(const RuleContext& context);
  const MatchCandidate* choose();
  double margin_of(const MatchCandidate& chosen) const;
  void follow(const MatchCandidate* chosen, double interval);
  void settle(const MatchCandidate& chosen);
  void report(const MatchCandidate* chosen);
  void set_anchor(double sigma);
  double value(const MatchCandidate& candidate) const;

  const RoadNetwork* network_;
  const RuleBases* rules_;
  MatchParameters parameters_;
  VehicleMotion motion_;
  PathFilter paths_;
  NearLinks near_;
  MatchResult result_;
  bool started_ = false;
  ReachGate gate_;
  LastMatch last_;
  double travelled_ = 0.0;  // m since last_
  DirectedLink winner_;     // link that initial matching found so far
  bool has_winner_ = false;
  double agreed_ = 0.0;    // s for which it has won without interruption
  double odometer_ = 0.0;  // m
  std::array<Anchor, anchor_count> anchors_{};
  std::size_t next_anchor_ = 0;
};

template <class Archive>
void Matcher::archive(Archive& ar) {
  archive_same_number(ar, "links of the road network", network_->size());
  archive_same_number(ar, "vertices of the road network", network_->data().vertices.size());
  archive_same_parameters(ar, parameters_);
  ar(motion_, paths_, started_, gate_, result_.stamp, result_.phase, last_.there, last_.link,
     last_.along, last_.has_anchor, last_.anchor, travelled_, winner_, has_winner_, agreed_,
     odometer_, anchors_, next_anchor_);
  if constexpr (Archive::loading) {
    if (last_.link.link >= network_->size() && network_->size() > 0)
      ar.fail("the last link does not exist");
  }
}

}  // namespace maploop::mapmatch
