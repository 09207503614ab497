#include "estimators/fusion/event_history.h"

#include <algorithm>
#include <limits>

namespace maploop::fusion {

EventHistory::EventHistory(std::size_t capacity) : events_(capacity) {
  order_.reserve(capacity);
  free_.reserve(capacity);
  clear();
}

bool EventHistory::contains(const EventKey& key) const {
  const std::size_t position = position_after(key);
  return position > 0 && (*this)[position - 1].key == key;
}

std::size_t EventHistory::position_after(const EventKey& key) const {
  const auto place = std::upper_bound(
      order_.begin(), order_.end(), key,
      [this](const EventKey& wanted, std::uint32_t i) { return wanted < events_[i].key; });
  return static_cast<std::size_t>(place - order_.begin());
}

std::size_t EventHistory::position_after(Time stamp) const {
  return position_after(
      EventKey{stamp, EventKind::clone, std::numeric_limits<std::uint64_t>::max()});
}

std::size_t EventHistory::open_slot(const EventKey& key) {
  const std::size_t position = position_after(key);
  const std::uint32_t slot = free_.back();
  free_.pop_back();
  events_[slot].key = key;
  order_.insert(order_.begin() + static_cast<std::ptrdiff_t>(position), slot);
  return position;
}

std::size_t EventHistory::after_last_sample(std::size_t position) const {
  while (position > 0 && (*this)[position - 1].key.kind != EventKind::imu) --position;
  return position;
}

const ImuSample* EventHistory::sample_from(std::size_t position) const {
  while (position < size() && (*this)[position].key.kind != EventKind::imu) ++position;
  return position < size() ? &std::get<ImuSample>((*this)[position].measurement) : nullptr;
}

InertialSamples EventHistory::samples_around(std::size_t position) const {
  const std::size_t first = after_last_sample(position);
  const ImuSample* before = past.sample ? &*past.sample : nullptr;
  if (first > 0) before = &std::get<ImuSample>((*this)[first - 1].measurement);
  return {before, sample_from(position), state_before(position).imu_repeated};
}

void EventHistory::pop_front() {
  const Event& oldest = (*this)[0];
  past.key = oldest.key;
  if (const auto* sample = std::get_if<ImuSample>(&oldest.measurement)) past.sample = *sample;
  free_.push_back(order_.front());
  order_.erase(order_.begin());
}

void EventHistory::clear() {
  order_.clear();
  free_.clear();
  for (std::size_t i = events_.size(); i > 0; --i) {
    free_.push_back(static_cast<std::uint32_t>(i - 1));
  }
}

}  // namespace maploop::fusion
