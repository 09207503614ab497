// The history holds the measurements of the last seconds in the order of their stamps, each with
// the filter state after it.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "estimators/fusion/filter_state.h"
#include "estimators/fusion/inertial_input.h"
#include "estimators/fusion/outcome.h"
#include "msgs/gnss.h"
#include "msgs/imu.h"
#include "msgs/map_feedback.h"
#include "msgs/odometry.h"
#include "msgs/wheel_speed.h"

namespace maploop::fusion {

// Events with equal stamps are processed in this order.
enum class EventKind : std::uint8_t {
  imu,
  start,
  wheel,
  gnss_velocity,
  gnss_position,
  map,
  odometry,
  clone
};

struct EventKey {
  Time stamp{};
  EventKind kind = EventKind::start;
  std::uint64_t sequence = 0;

  auto operator<=>(const EventKey&) const =
      default;  // NOLINT(modernize-use-nullptr): it takes a generated 0 for a pointer
};

template <class Archive>
void archive(Archive& ar, EventKey& key) {
  ar(key.stamp, key.kind, key.sequence);
}

// Requests a clone at the start of an odometry interval if no known odometry ends there.
struct CloneRequest {};

template <class Archive>
void archive(Archive&, CloneRequest&) {}

struct Event {
  EventKey key;
  std::variant<ImuSample, WheelSpeed, GnssFix, RelativeMotion, CloneRequest, MapFeedback>
      measurement;
  FilterState after;  // meaningful once the filter has started
  Outcome outcome;
};

// Has a fixed capacity and allocates all memory at construction. Positions count from the oldest
// event (0). Not thread-safe.
class EventHistory {
 public:
  // Summarizes the events that have left the history.
  struct Past {
    FilterState state;
    EventKey key;
    std::optional<ImuSample> sample;  // newest inertial sample among them
  };
  Past past;

  explicit EventHistory(std::size_t capacity);

  std::size_t size() const { return order_.size(); }
  bool full() const { return free_.empty(); }
  Event& operator[](std::size_t position) { return events_[order_[position]]; }
  const Event& operator[](std::size_t position) const { return events_[order_[position]]; }

  bool contains(const EventKey& key) const;
  // Returns the position of the first event after `key`, and after any event equal to it.
  std::size_t position_after(const EventKey& key) const;
  // Returns the position of the first event with a later stamp.
  std::size_t position_after(Time stamp) const;

  // Returns the state before the event at a position, which the older ones lead to.
  const FilterState& state_before(std::size_t position) const {
    return position == 0 ? past.state : (*this)[position - 1].after;
  }

  // Returns the position after the last inertial sample before `position`, or 0.
  std::size_t after_last_sample(std::size_t position) const;
  // Returns the first inertial sample from `position` on, or null.
  const ImuSample* sample_from(std::size_t position) const;
  // Returns the inertial samples before and from `position` on.
  InertialSamples samples_around(std::size_t position) const;

  // Inserts an event at its place in the order and returns its position. Its `after` and `outcome`
  // keep whatever values the slot held before. Preconditions: !full(), !contains(key).
  template <class Measurement>
  std::size_t insert(const EventKey& key, const Measurement& measurement) {
    const std::size_t position = open_slot(key);
    (*this)[position].measurement = measurement;
    return position;
  }

  // Removes the oldest event and notes its key and sample as past. Precondition: size() > 0.
  void pop_front();
  void clear();  // keeps the past

  template <class Archive>
  void archive(Archive& ar) {
    std::uint64_t count = size();
    ar(count);
    if constexpr (Archive::loading) {
      if (count > events_.size()) ar.fail("more events than the history holds");
      clear();
    }
    for (std::size_t i = 0; i < count; ++i) {
      EventKey key;
      if constexpr (!Archive::loading) key = (*this)[i].key;
      ar(key);
      Event& event = (*this)[Archive::loading ? open_slot(key) : i];
      ar(event.measurement, event.after, event.outcome);
    }
    ar(past.state, past.key, past.sample);
  }

 private:
  std::size_t open_slot(const EventKey& key);

  std::vector<Event> events_;
  std::vector<std::uint32_t> order_;  // indices into events_, oldest first
  std::vector<std::uint32_t> free_;
};

}  // namespace maploop::fusion
