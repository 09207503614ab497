// The feedback filter decides which parts of a match are returned to the filter that provided the
// fixes (Liu, Balazadegan Sarvrood and Gao, PE&RS 2018). Its conditions are: F1 still on the link,
// F2 azimuth like the link's, F3 no turning other than the link's, F4 away from junctions. In
// addition the link must be likely, no other link may be possible, and earlier feedback must have
// been consistent.
//
// Only the position across the road is returned, since the position of a matched point along the
// road is that of the fix itself. After a turn or a bend, the former along-road error lies across
// the new road and becomes observable.
#pragma once

#include <array>
#include <cstddef>

#include "mapmatch/match_result.h"
#include "mapmatch/parameter_table.h"
#include "mapmatch/vehicle_fix.h"
#include "msgs/map_feedback.h"
#include "msgs/parameter_archive.h"

namespace maploop::mapmatch {

// Not thread-safe. Allocates nothing. Decisions depend only on matches, fixes and their stamps.
class Feedback {
 public:
  // The network must outlive this object. Throws std::invalid_argument if a parameter is out of its
  // range.
  Feedback(const RoadNetwork& network, const FeedbackParameters& parameters);

  // Must be called with each match and its fix, in the order of stamps. Always returns a message;
  // its `reason` is none or states why nothing is fed back.
  MapFeedback decide(const LinkMatch& match, const VehicleFix& fix);

  template <class Archive>
  void archive(Archive& ar) {
    archive_same_parameters(ar, parameters_);
    ar(started_, stamp_, sequence_, on_link_, link_, odometer_, position_fed_at_, azimuth_fed_at_,
       fed_on_link_, has_road_, road_azimuth_, turned_, history_, next_moment_, window_, next_nis_);
    if constexpr (Archive::loading) {
      if (network_->size() > 0 && link_.link >= network_->size())
        ar.fail("the link of the last feedback does not exist");
    }
  }

 private:
  // Describes the road beside a fix.
  struct Line {
    Eigen::Vector2d point = Eigen::Vector2d::Zero();  // m, nearest on the link
    double along = 0.0;                               // m from where the link is entered
    double azimuth = 0.0;                             // rad, as driven
    bool straight = false;
    double half_width = 0.0;  // m
    double lane = 0.0;        // m to the right, expected position of a vehicle
  };
  // Holds the azimuth of the vehicle relative to the link at a fix.
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
  bool has_road_ = false;      // whether a position was ever fed back
  double road_azimuth_ = 0.0;  // rad, of the vehicle at the last feedback
  bool turned_ = false;        // since then, onto another road
  static constexpr std::size_t history_length = 64;
  std::array<Moment, history_length> history_{};
  std::size_t next_moment_ = 0;
  std::array<double, FeedbackParameters::max_window> window_{};
  std::size_t next_nis_ = 0;
};

}  // namespace maploop::mapmatch
