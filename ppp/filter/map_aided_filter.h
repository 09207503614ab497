// Runs the PPP filter with the road map beside the one without it, which takes over if a wrong road
// has misled the first: float ambiguities retain a wrong constraint for a long time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "msgs/map_feedback.h"
#include "ppp/filter/ppp_filter.h"

namespace maploop::ppp {

// A road was wrong if the filter with the map is farther from the one without it than the latter's
// error allows, or if line after line contradicts the filter. The map is then paused, and all that
// it contributed is discarded at once.
//
// This class is not thread-safe. Before the first feedback, and after a wrong road, there is one
// filter, and its results equal those of a PppFilter bit for bit.
class MapAidedFilter {
 public:
  explicit MapAidedFilter(PppFilter filter, const PppParameters& parameters)
      : map_free_(std::move(filter)), aided_(map_free_), parameters_(parameters) {}

  // Works as PppFilter::process() does. Returns the solution with the map, if the map contributes
  // to it.
  const PppSolution& process(const Epoch& epoch, const CarriedMotion* carried = nullptr);
  // Applies feedback to the state of the last epoch; it shows in the next solution.
  MapUse add(const MapFeedback& feedback);

  // Works as PppFilter::note_road(), for both filters: it says nothing of the position.
  void note_road(const MapFeedback& feedback) {
    map_free_.note_road(feedback);
    if (aiding_) aided_.note_road(feedback);
  }

  const PppSolution& solution() const { return aided() ? aided_.solution() : map_free_.solution(); }
  const PppSolution& map_free() const { return map_free_.solution(); }
  const PppParameters& parameters() const { return parameters_; }
  bool aided() const { return aiding_; }
  bool paused() const { return time_ < paused_until_; }
  // These counts tell what happened to each feedback, and how often the map's contribution was
  // discarded.
  std::uint64_t count(MapUse use) const { return uses_[static_cast<std::size_t>(use)]; }
  std::uint64_t restorations() const { return restorations_; }
  // The counts begin at 0 again, also those of restarts.
  void count_anew();

  GpsTime last_epoch() const { return time_; }

  static constexpr std::size_t largest_archive = 2 * PppFilter::largest_archive + 512;

  // Saves and loads as PppFilter::archive() does.
  template <class Archive>
  void archive(Archive& ar) {
    ar.section("ppp with the map", 1);
    if constexpr (Archive::loading) {
      MapAidedFilter loaded = *this;
      loaded.archive_state(ar);
      *this = std::move(loaded);
    } else {
      archive_state(ar);
    }
  }

 private:
  template <class Archive>
  void archive_state(Archive& ar) {
    ar(map_free_, aiding_);
    if (aiding_) ar(aided_);
    ar(time_, apart_since_, paused_until_, aiding_since_, pauses_, gated_in_a_row_, uses_,
       restorations_);
  }

  MapUse apply(const MapFeedback& feedback);
  std::optional<double> distance() const;
  void compare();
  void handle_contradiction();
  void pause();
  void restore();

  PppFilter map_free_, aided_;
  PppParameters parameters_;
  bool aiding_ = false;  // if false, aided_ is not in use
  GpsTime time_{};
  std::optional<GpsTime> apart_since_;
  GpsTime paused_until_{};
  GpsTime aiding_since_{};
  int pauses_ = 0;  // number of pauses in short succession
  int gated_in_a_row_ = 0;
  std::array<std::uint64_t, map_use_count> uses_{};
  std::uint64_t restorations_ = 0;
};

}  // namespace maploop::ppp
