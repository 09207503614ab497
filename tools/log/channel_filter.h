// Selects the channels that a command works on.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>

namespace maploop::lcm_log {

class ChannelFilter {
 public:
  // Selects every channel.
  ChannelFilter() = default;

  // Selects the channels whose whole name the regular expression (POSIX extended) matches. Throws
  // std::invalid_argument stating its error.
  explicit ChannelFilter(const std::string& pattern);

  // Selects every channel except these.
  explicit ChannelFilter(std::set<std::string, std::less<>> without);

  bool takes(std::string_view channel);

 private:
  struct Pattern;

  bool decide(const std::string& channel) const;

  std::shared_ptr<const Pattern> pattern_;  // shared by copies of a filter
  std::set<std::string, std::less<>> without_;
  std::unordered_map<std::string, bool> decided_;  // cached, because matching is slow
  std::string channel_;                            // reused key
};

}  // namespace maploop::lcm_log
