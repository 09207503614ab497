// Counts what the ppp stage refuses and loses, by reason.
#pragma once

#include <atomic>
#include <cstdint>
#include <string_view>
#include <vector>

#include "msgs/diagnostics.h"
#include "msgs/ppp_state.h"
#include "ppp/filter/solution.h"
#include "runtime/vehicle/health/reason_counts.h"

namespace maploop::vehicle {

// The stage's thread counts; any thread reads.
struct PppCounts {
  ReasonCounts<PppRefusal, count_of<PppRefusal>> refused;
  ReasonCounts<PppSlip, count_of<PppSlip>> slipped;
  ReasonCounts<ppp::HeightUse, count_of<ppp::HeightUse>> heights;  // where there is a model
  std::atomic<std::uint64_t> without_position{0};
  std::atomic<std::uint64_t> restarts{0};
  std::atomic<std::uint64_t> forgotten_roads{0};
  std::atomic<std::uint64_t> uncorrected{0};  // epochs, where corrections are received
  std::atomic<std::uint64_t> outdated{0};     // states of an earlier run

  static constexpr std::string_view of_another_time = "state of the last run: of another time";

  // Counts the satellites of an epoch, and whether it has a position.
  void note(const PppState& state);
  std::vector<RefusalCount> refusals() const;

  // Saves and loads what the recorded data decide.
  template <class Archive>
  void archive(Archive& ar) {
    const auto number = [&ar](std::atomic<std::uint64_t>& value) {
      std::uint64_t saved = value;
      ar(saved);
      if constexpr (Archive::loading) value = saved;
    };
    ar(refused, slipped, heights);
    number(without_position);
    number(restarts);
    number(forgotten_roads);
  }
};

}  // namespace maploop::vehicle
