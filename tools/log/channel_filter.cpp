#include "tools/log/channel_filter.h"

// POSIX is used instead of std::regex, whose recursion can overflow the stack for a long channel
// name.
#include <regex.h>

#include <array>
#include <memory>
#include <stdexcept>
#include <unordered_map>

namespace maploop::lcm_log {

ChannelFilter matching(const std::string& pattern) {
  const std::shared_ptr<regex_t> regex(new regex_t{}, [](regex_t* compiled) {
    regfree(compiled);
    delete compiled;
  });
  if (const int error = regcomp(regex.get(), pattern.c_str(), REG_EXTENDED)) {
    std::array<char, 200> why{};
    regerror(error, regex.get(), why.data(), why.size());
    throw std::invalid_argument("the channels '" + pattern +
                                "' are not a regular expression: " + why.data());
  }
  // Decisions are remembered, because matching is slow; a malicious log may have any number of
  // channels.
  constexpr std::size_t remembered = 1000;
  return
      [regex, decided = std::unordered_map<std::string, bool>()](std::string_view channel) mutable {
        const std::string name(channel);
        if (const auto known = decided.find(name); known != decided.end()) return known->second;
        // The leftmost match is the longest one, so that it is the whole name if the whole name
        // matches.
        regmatch_t match{};
        const bool taken = regexec(regex.get(), name.c_str(), 1, &match, 0) == 0 &&
                           match.rm_so == 0 && static_cast<std::size_t>(match.rm_eo) == name.size();
        if (decided.size() < remembered) decided.emplace(name, taken);
        return taken;
      };
}

}  // namespace maploop::lcm_log
