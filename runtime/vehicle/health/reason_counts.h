// How often each reason of an enumeration occurred.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/diagnostics.h"

namespace maploop::vehicle {

// One thread adds; any thread reads. `Reason` has `size` values from 0 on, of which 0 stands for no
// refusal, and a to_string().
template <class Reason, std::size_t size>
class ReasonCounts {
 public:
  void add(Reason reason) {
    counts_[static_cast<std::size_t>(reason)].fetch_add(1, std::memory_order_relaxed);
  }

  // Returns those that occurred, in their order.
  std::vector<RefusalCount> of(std::string_view stage) const {
    std::vector<RefusalCount> list;
    append_to(list, stage);
    return list;
  }
  // Appends them, with `prefix` before their names.
  void append_to(std::vector<RefusalCount>& list, std::string_view stage,
                 std::string_view prefix = "") const {
    for (std::size_t i = 1; i < size; ++i) {
      const std::uint64_t count = counts_[i].load(std::memory_order_relaxed);
      if (count == 0) continue;
      const std::string_view name = to_string(static_cast<Reason>(i));
      list.push_back({std::string(stage), std::string(prefix).append(name), count});
    }
  }

  template <class Archive>
  void archive(Archive& ar) {
    std::array<std::uint64_t, size> counts{};
    std::copy(counts_.begin(), counts_.end(), counts.begin());
    ar(counts);
    if constexpr (Archive::loading) std::copy(counts.begin(), counts.end(), counts_.begin());
  }

 private:
  std::array<std::atomic<std::uint64_t>, size> counts_{};
};

}  // namespace maploop::vehicle
