#include "tools/lcm_log/channel_filter.h"

#include <stdexcept>
#include <utility>

namespace maploop::lcm_log {
namespace {

constexpr std::size_t kMaximumDecided = 1000;  // a hostile log may have any number of channels

std::regex compile(const std::string& pattern) {
  try {
    return std::regex(pattern, std::regex::ECMAScript | std::regex::optimize);
  } catch (const std::regex_error& e) {
    throw std::invalid_argument("the channels '" + pattern +
                                "' are no regular expression: " + e.what());
  }
}

}  // namespace

ChannelFilter::ChannelFilter(const std::string& pattern) : pattern_(compile(pattern)) {}

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
  if (pattern_) return std::regex_match(channel, *pattern_);
  return !without_.contains(channel);
}

}  // namespace maploop::lcm_log
