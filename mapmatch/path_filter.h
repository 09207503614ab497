// Path hypotheses collect the evidence of all fixes so far for each link on which the vehicle may
// be.
//
// Each hypothesis is a path through the network with a Kalman filter of the vehicle's position on
// it, which is predicted by the distance travelled and corrected by the fixes. Its weight depends
// on how well positions and azimuths fit. Hypotheses divide at junctions, new ones are created near
// the fix each second, and those far less likely than the best are removed, so their number is
// bounded. (The idea of multi-hypothesis map matching: Pyo, Shin and Sung, "Development of a map
// matching method using the multiple hypothesis technique", ITSC 2001.) Not thread-safe. Does not
// allocate after construction.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "mapmatch/candidate_search.h"
#include "mapmatch/match_parameters.h"
#include "mapmatch/path_kalman.h"

namespace maploop::mapmatch {

class PathFilter {
 public:
  static constexpr std::size_t capacity = 64;

  PathFilter(const RoadNetwork& network, const MatchParameters& parameters)
      : network_(&network), parameters_(&parameters), kalman_(network, parameters) {}

  void reset();
  void step(const PathEvidence& evidence, const NearLinks& near);

  std::span<const PathHypothesis> hypotheses() const { return {hypotheses_.data(), count_}; }
  // Returns the hypothesis's share of all evidence, given that the vehicle is on a mapped road
  // (off_road() is separate).
  double share(const PathHypothesis& h) const { return std::exp(h.log_weight); }
  double off_road() const { return 1.0 / (1.0 + std::exp(-off_road_)); }

  // Returns P that the vehicle is on a road beside the hypothesis's that the map does not contain,
  // from its trust and the present misfit of the likely links. off_road() reacts more slowly and
  // more reliably.
  double unmapped(const PathHypothesis& h) const;

  template <class Archive>
  void archive(Archive& ar);

 private:
  void divide(const PathEvidence& e);
  void take_exits(const PathHypothesis& h);
  void add_exit(const PathHypothesis& h, DirectedLink exit, double cost);
  void turn_round(const PathEvidence& e);
  void begin_paths(const PathEvidence& e, const NearLinks& near);
  void judge_road(const PathEvidence& e);
  void merge();
  void normalize();
  void add(const PathHypothesis& h);

  double cost_of(DirectedLink link) const;

  const RoadNetwork* network_;
  const MatchParameters* parameters_;
  PathKalman kalman_;
  std::array<PathHypothesis, capacity> hypotheses_{};
  std::size_t count_ = 0;
  double off_road_ = -6.0;    // log odds
  double surprise_ = 0.0;     // mean misfit of all hypotheses, weighted by their shares
  double since_birth_ = 0.0;  // s
};

template <class Archive>
void PathFilter::archive(Archive& ar) {
  auto count = static_cast<std::uint32_t>(count_);
  ar(count);
  if constexpr (Archive::loading) {
    if (count > capacity) ar.fail("more path hypotheses than the filter has room for");
    count_ = count;
  }
  for (std::size_t i = 0; i < count_; ++i) {
    PathHypothesis& h = hypotheses_[i];
    ar(h);
    if constexpr (Archive::loading) {
      for (const DirectedLink d : {h.link, h.previous, h.next})
        if (d.link >= network_->size()) ar.fail("a hypothesis is on a link that does not exist");
    }
  }
  ar(off_road_, surprise_, since_birth_);
}

}  // namespace maploop::mapmatch
