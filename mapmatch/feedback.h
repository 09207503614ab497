// Decides what of a match goes back to the filter that the fixes came from (the "feedback filter"
// of Liu, Balazadegan Sarvrood and Gao, PE&RS 2018): F1 still on the link, F2 azimuth like the
// link's, F3 not turning otherwise than the link, F4 away from junctions; and that the link is
// likely, that no other one is possible, and that what went back so far was consistent.
//
// Across the road only: a matched point's place along it is the fix's own. What turns or bends
// into the direction across makes that known, too.
#pragma once

#include <array>
#include <cstddef>

#include "mapmatch/feedback_parameters.h"
#include "mapmatch/match_result.h"
#include "mapmatch/vehicle_fix.h"
#include "msgs/map_feedback.h"

namespace maploop::mapmatch {

// Not thread-safe. Allocates nothing. Decides by matches, fixes and their stamps alone.
class Feedback {
 public:
  // The network must outlive it.
  Feedback(const RoadNetwork& network, const FeedbackParameters& parameters)
      : network_(&network), parameters_(parameters) {}

  // Of each match in the order of stamps, with its fix. Always says something: `reason` where
  // nothing goes back.
  MapFeedback decide(const LinkMatch& match, const VehicleFix& fix);

  template <class Archive>
  void archive(Archive& ar) {
    ar(started_, stamp_, sequence_, on_link_, link_, odometer_, position_fed_at_, azimuth_fed_at_,
       fed_on_link_, has_road_, road_azimuth_, turned_, history_, next_moment_, window_, next_nis_);
    if constexpr (Archive::loading) {
      if (network_->size() > 0 && link_.link >= network_->size())
        ar.fail("the link of the last feedback is not there");
    }
  }

 private:
  // The road beside a fix.
  struct Line {
    Eigen::Vector2d point = Eigen::Vector2d::Zero();  // m, nearest on the link
    double along = 0.0;                               // m from where the link is entered
    double azimuth = 0.0;                             // rad, as driven
    bool straight = false;
    double half_width = 0.0;  // m
    double lane = 0.0;        // m to the right, where a vehicle is expected
  };
  // How the vehicle stood to the link at a fix.
  struct Moment {
    Time stamp{};
    double azimuth_error = 0.0;  // rad
    template <class Archive>
    void archive(Archive& ar) {
      ar(stamp, azimuth_error);
    }
  };

  Line line_beside(DirectedLink link, const Eigen::Vector2d& place) const;
  FeedbackReason check(const LinkMatch& match, const VehicleFix& fix, const Line& line);
  bool lost(const VehicleFix& fix) const;
  bool turns(Time stamp, double azimuth_error, double interval) const;
  bool parallel(const LinkMatch& match, const VehicleFix& fix, const Line& line) const;
  bool consistent() const;
  void note_nis(double nis);

  const RoadNetwork* network_;
  FeedbackParameters parameters_;
  bool started_ = false;
  Time stamp_{};
  std::uint64_t sequence_ = 0;
  bool on_link_ = false;
  DirectedLink link_;
  double odometer_ = 0.0;          // m
  double position_fed_at_ = -1e9;  // m
  double azimuth_fed_at_ = -1e9;   // m
  int fed_on_link_ = 0;
  bool has_road_ = false;      // whether there was any feedback
  double road_azimuth_ = 0.0;  // rad, of the vehicle at the last feedback
  bool turned_ = false;        // since then, into another road
  static constexpr std::size_t history_length = 64;
  std::array<Moment, history_length> history_{};
  std::size_t next_moment_ = 0;
  static constexpr std::size_t max_window = 64;
  std::array<double, max_window> window_{};
  std::size_t next_nis_ = 0;
};

}  // namespace maploop::mapmatch
