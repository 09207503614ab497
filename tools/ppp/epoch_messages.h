// Collects the messages of epochs, which are mostly the same one many times.
#pragma once

#include <algorithm>
#include <map>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "ppp/filter/solution.h"

namespace maploop::gnss {

// Counts how many epochs have each message.
class EpochMessages {
 public:
  void add(const ppp::PppSolution& s) {
    const auto [entry, is_new] = entries_.try_emplace(s.message, Entry{s.time, 0});
    ++entry->second.count;
  }
  // Writes each message once, in the order of their first epochs.
  void write(std::ostream& out) const {
    std::vector<std::pair<std::string, Entry>> all(entries_.begin(), entries_.end());
    std::ranges::stable_sort(all, {}, [](const auto& entry) { return entry.second.first; });
    for (const auto& [message, entry] : all) {
      out << format_gps_time(entry.first) << ": " << message;
      if (entry.count > 1) out << " (" << entry.count << " epochs, of which this is the first)";
      out << '\n';
    }
  }

 private:
  struct Entry {
    ppp::GpsTime first;
    int count = 0;
  };
  std::map<std::string, Entry> entries_;
};

}  // namespace maploop::gnss
