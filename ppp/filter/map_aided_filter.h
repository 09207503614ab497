// The PPP filter with the road map beside the one without, which takes its place where a wrong
// road has led it astray: ambiguities keep for long what they have once been told.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "msgs/map_feedback.h"
#include "ppp/filter/ppp_filter.h"

namespace maploop::ppp {

// Where the filter with the map is farther from the one without than that one may be wrong, or
// line after line contradicts it, the road was a wrong one: the map is left out for a while, and
// what it said is forgotten at once.
//
// Not thread-safe. Before the first feedback, and after a wrong road, there is one filter, and
// its bits are those of a PppFilter.
class MapAidedFilter {
 public:
  explicit MapAidedFilter(PppFilter filter, const PppParameters& parameters)
      : free_(std::move(filter)), aided_(free_), parameters_(parameters) {}

  // As PppFilter's: the solution with the map, if the map has said anything.
  const PppSolution& process(const Epoch& epoch);
  // About the last epoch; the next solution knows it.
  MapUse add(const MapFeedback& feedback);

  const PppSolution& solution() const { return aided() ? aided_.solution() : free_.solution(); }
  const PppSolution& map_free() const { return free_.solution(); }
  const PppParameters& parameters() const { return parameters_; }
  bool aided() const { return aiding_; }
  bool paused() const { return time_ < paused_until_; }
  // What became of feedbacks, and how often what they had said was forgotten.
  std::uint64_t count(MapUse use) const { return uses_[static_cast<std::size_t>(use)]; }
  std::uint64_t restorations() const { return restorations_; }

  static constexpr std::size_t largest_archive = 2 * PppFilter::largest_archive + 512;

  // As PppFilter's.
  template <class Archive>
  void archive(Archive& ar) {
    ar.section("ppp with the map", 1);
    if constexpr (Archive::loading) {
      MapAidedFilter loaded = *this;
      loaded.archive_knowledge(ar);
      *this = std::move(loaded);
    } else {
      archive_knowledge(ar);
    }
  }

 private:
  template <class Archive>
  void archive_knowledge(Archive& ar) {
    ar(free_, aiding_);
    if (aiding_) ar(aided_);
    ar(time_, apart_since_, paused_until_, aiding_since_, pauses_, gated_in_a_row_, uses_,
       restorations_);
  }

  MapUse use(const MapFeedback& feedback);
  double distance() const;
  bool both_have_positions() const;
  Eigen::Vector2d apart() const;
  void doubt();
  void pause();
  void watch();
  void restore();

  PppFilter free_, aided_;
  PppParameters parameters_;
  bool aiding_ = false;  // else the aided one is of no account
  GpsTime time_{};
  std::optional<GpsTime> apart_since_;
  GpsTime paused_until_{};
  GpsTime aiding_since_{};
  int pauses_ = 0;  // one soon after the other
  int gated_in_a_row_ = 0;
  std::array<std::uint64_t, map_use_count> uses_{};
  std::uint64_t restorations_ = 0;
};

}  // namespace maploop::ppp
