#include "tools/log/channel_filter.h"

// POSIX is used instead of std::regex, whose recursion can overflow the stack for a long channel
// name.
#include <regex.h>

#include <array>
#include <stdexcept>
#include <utility>

namespace maploop::lcm_log {
namespace {

constexpr std::size_t kMaximumDecided = 1000;  // a malicious log may have any number of channels

}  // namespace

struct ChannelFilter::Pattern {
  explicit Pattern(const std::string& text) {
    const int error = regcomp(&regex, text.c_str(), REG_EXTENDED);
    if (error == 0) return;
    std::array<char, 200> why{};
    regerror(error, &regex, why.data(), why.size());
    throw std::invalid_argument("the channels '" + text +
                                "' are no regular expression: " + why.data());
  }
  ~Pattern() { regfree(&regex); }
  Pattern(const Pattern&) = delete;
  Pattern& operator=(const Pattern&) = delete;

  // The leftmost match is the longest one, so that it is the whole name if the whole name matches.
  bool matches_whole(const std::string& name) const {
    regmatch_t match{};
    return regexec(&regex, name.c_str(), 1, &match, 0) == 0 && match.rm_so == 0 &&
           static_cast<std::size_t>(match.rm_eo) == name.size();
  }

  regex_t regex{};
};

ChannelFilter::ChannelFilter(const std::string& pattern)
    : pattern_(std::make_shared<const Pattern>(pattern)) {}

ChannelFilter::ChannelFilter(std::set<std::string, std::less<>> without)
    : without_(std::move(without)) {}

bool ChannelFilter::takes(std::string_view channel) {
  channel_ = channel;
  if (const auto known = decided_.find(channel_); known != decided_.end()) return known->second;
  const bool taken = decide(channel_);
  if (decided_.size() < kMaximumDecided) decided_.emplace(channel_, taken);
  return taken;
}

bool ChannelFilter::decide(const std::string& channel) const {
  if (pattern_) return pattern_->matches_whole(channel);
  return !without_.contains(channel);
}

}  // namespace maploop::lcm_log
