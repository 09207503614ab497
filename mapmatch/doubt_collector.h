// The doubt collector finds where a drive contradicts the road map: a road that the map lacks, a
// one-way street driven against its direction, a turn that the map forbids, and a road that was
// driven beside its line.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "mapmatch/drive_stretch.h"
#include "mapmatch/match_parameters.h"
#include "mapmatch/match_result.h"
#include "msgs/map_doubt.h"

namespace maploop::mapmatch {

// Returns P that a road is shifted, if a vehicle drove on it `offset` metres beside its line, whose
// sigma is `sigma`: (18) of METHOD.md.
double probability_of_shift(double offset, double sigma, double half_width);

// Not thread-safe. Allocates nothing. What it finds depends only on matches, fixes and their
// stamps.
class DoubtCollector {
 public:
  // The network must outlive this object. The parameters are those of the matcher; without paths it
  // has no probabilities, and every doubt is unlikely.
  DoubtCollector(const RoadNetwork& network, const MatchParameters& parameters);

  // Takes each match with its fix, in the order of stamps; a match that was refused is passed over.
  // Returns the doubts that ended with it, unlikely ones too; `available` and `sequence` are the
  // caller's. The result is valid until the next call.
  std::span<const MapDoubt> add(const LinkMatch& match, const VehicleFix& fix);
  // Ends the drive: returns the doubts that ended with it.
  std::span<const MapDoubt> finish();

  // Archives the whole state.
  template <class Archive>
  void archive(Archive& ar) {
    ar(started_, jumped_, stamp_, place_, away_, link_, last_, before_);
    if constexpr (Archive::loading) {
      const auto check = [&](const MapDoubt::Segment& segment, bool there) {
        if ((there || segment.way_id != 0) && segment.link.link >= network_->size())
          ar.fail("a link that was driven does not exist");
      };
      check(away_.segment, false);
      check(link_.segment, link_.there);
      check(last_, false);
      for (const Driven& driven : before_) check(driven.segment, false);
    }
  }

 private:
  // The drive along one link, or since it was left for no road of the map.
  struct Visit {
    bool there = false;
    bool sure = false;          // away: whether the matcher found no link
    MapDoubt::Segment segment;  // where it began
    DriveStretch stretch;
    // Integrals along the link: of the offset to the right (m^2), its variance (m^3), and 1 (m).
    double offset = 0.0, variance = 0.0, judged = 0.0;

    void archive(auto& ar) { ar(there, sure, segment, stretch, offset, variance, judged); }
  };

  // A link that was driven before.
  struct Driven {
    MapDoubt::Segment segment;  // where it began; no way: there is none
    double probability = 0.0;

    void archive(auto& ar) { ar(segment, probability); }
  };

  // The way from the last fix to this one.
  struct Step {
    Eigen::Vector2d place;  // m, of this fix
    double metres = 0.0;
  };

  Step advance(const VehicleFix& fix);
  MapDoubt::Segment segment_at(DirectedLink link, double along) const;
  void follow_away(const LinkMatch& match, const VehicleFix& fix, const Step& step);
  void follow_link(const LinkMatch& match, const VehicleFix& fix, const Step& step);
  void measure_offset(const LinkMatch& match, const VehicleFix& fix, const Step& step);
  void end_away(const MapDoubt::Segment& to);
  void leave_link();
  void judge_turn(const Visit& to);
  void judge_offset(const Visit& visit);
  MapDoubt& add_doubt(DoubtKind kind, const Visit& visit, double probability);

  const RoadNetwork* network_;
  Duration max_gap_;
  bool jumped_ = false;  // the fixes, and they have not been on a road since
  Box area_;             // m, of all roads, and a margin
  bool started_ = false;
  Time stamp_{};                                     // of the last fix
  Eigen::Vector2d place_ = Eigen::Vector2d::Zero();  // m, from which the way is measured
  Visit away_, link_;
  MapDoubt::Segment last_;  // of the road at the last fix that was on one
  // The newest first: near a junction, a link may be matched that was not driven.
  std::array<Driven, 3> before_{};
  std::array<MapDoubt, 4> found_{};
  std::size_t found_count_ = 0;
};

}  // namespace maploop::mapmatch
