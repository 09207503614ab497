// The state of the spy on a terminal: the selected channel, the typed text, and the resulting
// picture.
#pragma once

#include <cstddef>
#include <string>
#include <utility>

#include "tools/log/channel_filter.h"
#include "tools/spy/traffic.h"

namespace maploop::spy {

// Selects the channels whose name the regular expression matches anywhere; all if it is empty.
// Throws std::invalid_argument stating its error.
lcm_log::ChannelFilter filter_of(const std::string& expression);

// An object belongs to one thread.
class Screen {
 public:
  // `expression` is the initial filter, which must be valid.
  Screen(std::string source, const std::string& expression)
      : source_(std::move(source)), expression_(expression), filter_(filter_of(expression)) {}

  // Takes a key as the terminal sends it; an arrow consists of three.
  void press(char key);
  bool quit() const { return quit_; }

  // Returns the whole picture for a terminal of this size.
  std::string picture(const Traffic& traffic, Duration now, std::size_t rows, std::size_t columns);

 private:
  void type(char key);

  std::string source_;
  std::string expression_;
  lcm_log::ChannelFilter filter_;
  std::string selected_;  // a channel's name
  long moves_ = 0;        // moves of the selection since the last picture
  std::size_t first_field_ = 0;
  std::string sequence_;  // an incomplete escape sequence
  bool typing_ = false;   // whether a filter is being typed
  std::string typed_;
  std::string complaint_;
  bool quit_ = false;
};

}  // namespace maploop::spy
