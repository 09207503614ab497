// Path hypotheses: the evidence of all fixes so far for each link the vehicle may be on.
//
// Each hypothesis is a way through the network with a Kalman filter of the vehicle's place on it,
// predicted by the distance travelled and corrected by the fixes. Its weight grows with how well
// positions and azimuths fit. At junctions hypotheses divide, everywhere new ones are born, and
// those that fall far behind end: their number is bounded. (The idea of multi-hypothesis map
// matching: Pyo, Shin and Sung, "Development of a map matching method using the multiple hypothesis
// technique", ITSC 2001.) No allocation after construction.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

#include "mapmatch/candidate_search.h"
#include "mapmatch/match_parameters.h"
#include "mapmatch/path_hypothesis.h"
#include "mapmatch/vehicle_motion.h"

namespace maploop::mapmatch {

// What a fix tells a hypothesis.
struct PathEvidence {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();           // m
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  // of the fix
  Motion motion;
};

class PathFilter {
 public:
  static constexpr std::size_t capacity = 64;

  PathFilter(const RoadNetwork& network, const MatchParameters& parameters)
      : network_(&network), parameters_(&parameters) {}

  void reset();
  void step(const PathEvidence& evidence, const NearLinks& near);

  std::span<const PathHypothesis> hypotheses() const { return {hypotheses_.data(), count_}; }
  // The share of all evidence; off_road() is apart from it.
  double share(const PathHypothesis& h) const { return std::exp(h.log_weight); }
  double off_road() const { return 1.0 / (1.0 + std::exp(-off_road_)); }

  // P that it is on a road that the map does not have: of what the likeliest links leave
  // unexplained at this moment. Slower and surer is off_road().
  double unmapped() const;

  template <class Archive>
  void archive(Archive& ar);

 private:
  void predict(PathHypothesis& h, const PathEvidence& e) const;
  void divide(const PathEvidence& e);
  void enter_link(PathHypothesis& h, const PathEvidence& e) const;
  void take_exits(const PathHypothesis& h);
  void add_exit(const PathHypothesis& h, DirectedLink exit, double cost);
  void turn_round(const PathEvidence& e);
  void correct(PathHypothesis& h, const PathEvidence& e) const;
  void correct_by_azimuth(PathHypothesis& h, const PathEvidence& e) const;
  void be_born(const PathEvidence& e, const NearLinks& near);
  void judge_road(const PathEvidence& e);
  void merge();
  void normalize();
  void add(const PathHypothesis& h);

  Eigen::Matrix2d slow_covariance(const PathEvidence& e) const;
  Eigen::Matrix2d fast_covariance(const PathEvidence& e) const;
  double azimuth_at(const PathHypothesis& h, double s) const;
  double azimuth_error(const PathHypothesis& h, const PathEvidence& e) const;
  double corner_cut(const PathEvidence& e) const;
  double cost_of(DirectedLink link) const;

  const RoadNetwork* network_;
  const MatchParameters* parameters_;
  std::array<PathHypothesis, capacity> hypotheses_{};
  std::size_t count_ = 0;
  double off_road_ = -6.0;    // log odds
  double surprise_ = 0.0;     // misfit of all hypotheses, by their shares
  double since_birth_ = 0.0;  // s
};

template <class Archive>
void PathFilter::archive(Archive& ar) {
  auto count = static_cast<std::uint32_t>(count_);
  ar(count);
  if constexpr (Archive::loading) {
    if (count > capacity) ar.fail("more path hypotheses than there is room for");
    count_ = count;
  }
  for (std::size_t i = 0; i < count_; ++i) {
    PathHypothesis& h = hypotheses_[i];
    ar(h);
    if constexpr (Archive::loading) {
      for (const DirectedLink d : {h.link, h.previous, h.next})
        if (d.link >= network_->size()) ar.fail("a hypothesis is on a link that is not there");
    }
  }
  ar(off_road_, surprise_, since_birth_);
}

}  // namespace maploop::mapmatch
