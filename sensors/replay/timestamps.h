// KITTI's timestamps.txt: line i + 1 is the stamp of frame i.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "msgs/time.h"
#include "sensors/source.h"

namespace maploop::sensors {

// Why a frame is left out; nothing for a frame that stands.
using Verdicts = std::vector<std::optional<Finding>>;

// The stamps of one file. A frame whose line is no stamp has a verdict that says so.
struct Timestamps {
  std::filesystem::path file;
  std::vector<Time> stamps;
  Verdicts verdicts;  // as many as stamps

  std::size_t size() const { return stamps.size(); }
};

// The files hold Karlsruhe's local time without saying so; it is read as UTC (2 h late in summer,
// the same for every sensor). Any number of fractional digits up to nine, LF or CRLF. Throws
// std::runtime_error naming the file when there is not one stamp in it.
Timestamps parse_timestamps(std::string_view text, const std::filesystem::path& file);
Timestamps read_timestamps(const std::filesystem::path& file);

// The verdict on frame `i` of one of several files that belong together: its own, or that the file
// has no such line.
std::optional<Finding> verdict(const Timestamps& timestamps, std::size_t i);

// Gives a verdict to the frames that break the order of time. Of those that still stand, the
// longest strictly increasing subsequence stays (the earliest of several), so that one wrong stamp
// costs one frame and not all that follow it. Of what is more than input_limits::longest_gap apart
// stays the part with the most frames. `file` is the one to blame.
void refuse_out_of_order(const std::vector<Time>& stamps, const std::filesystem::path& file,
                         Verdicts& verdicts);

// Verdicts on the numbered files of `folder` that lie beyond the last of `frames` stamps.
std::vector<Finding> files_without_stamp(const std::filesystem::path& folder, std::size_t frames);

}  // namespace maploop::sensors
