// The spy on a terminal: which channel is looked at, what has been typed, and the picture of it
// all.
#pragma once

#include <cstddef>
#include <string>

#include "msgs/lcm/schema.h"
#include "tools/lcm_log/channel_filter.h"
#include "tools/spy/traffic.h"

namespace maploop::spy {

// The channels whose name the regular expression matches anywhere; all for an empty one. Throws
// std::invalid_argument saying what is wrong with it.
lcm_log::ChannelFilter filter_of(const std::string& expression);

// One thread's own.
class Screen {
 public:
  // `expression`: the filter to begin with, which must be valid. The schema must outlive it.
  Screen(const schema::Schema& schema, std::string source, const std::string& expression);

  // A key as the terminal sends it; an arrow comes in three.
  void press(char key);
  bool quit() const { return quit_; }

  // The whole picture for a terminal of this size.
  std::string picture(const Traffic& traffic, Duration now, std::size_t rows, std::size_t columns);

 private:
  void obey(const std::string& sequence);
  void type(char key);

  const schema::Schema& schema_;
  std::string source_;
  std::string expression_;
  lcm_log::ChannelFilter filter_;
  std::string selected_;  // a channel's name
  long moves_ = 0;        // of the selection, since the last picture
  std::size_t first_field_ = 0;
  std::string sequence_;  // an escape sequence that is still coming
  bool typing_ = false;   // a filter
  std::string typed_;
  std::string complaint_;
  bool quit_ = false;
};

}  // namespace maploop::spy
