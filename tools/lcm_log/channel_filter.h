// Which channels a command works on.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>

namespace maploop::lcm_log {

class ChannelFilter {
 public:
  // Every channel.
  ChannelFilter() = default;

  // Those whose whole name the regular expression (POSIX extended) matches. Throws
  // std::invalid_argument saying what is wrong with it.
  explicit ChannelFilter(const std::string& pattern);

  // Every channel but these.
  explicit ChannelFilter(std::set<std::string, std::less<>> without);

  bool takes(std::string_view channel);

 private:
  struct Pattern;

  bool decide(const std::string& channel) const;

  std::shared_ptr<const Pattern> pattern_;  // copies of a filter share it
  std::set<std::string, std::less<>> without_;
  std::unordered_map<std::string, bool> decided_;  // matching is slow beside reading
  std::string channel_;                            // reused key
};

}  // namespace maploop::lcm_log
