// This file reads KITTI's timestamps.txt: line i + 1 is the stamp of frame i.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "msgs/time.h"
#include "sensors/source.h"

namespace maploop::sensors {

// Why each frame is left out; nothing for a frame that is kept.
using Verdicts = std::vector<std::optional<Finding>>;

// Holds the stamps of one file. A frame whose line is not a stamp has a verdict that states this.
struct Timestamps {
  std::filesystem::path file;
  std::vector<Time> stamps;
  Verdicts verdicts;  // one for each stamp

  std::size_t size() const { return stamps.size(); }
};

// The files contain Karlsruhe's local time without stating so; it is read as UTC (2 h late in
// summer, the same for every sensor). Accepts up to nine fractional digits, LF or CRLF. Throws
// std::runtime_error that names the file if it does not contain any stamp.
Timestamps parse_timestamps(std::string_view text, const std::filesystem::path& file);
Timestamps read_timestamps(const std::filesystem::path& file);

// Returns the verdict on frame `i` of one of several files that belong together: its own, or that
// the file has no such line.
std::optional<Finding> verdict(const Timestamps& timestamps, std::size_t i);

// Gives a verdict to the frames that break the order of time. Among those without a verdict, the
// longest strictly increasing subsequence is kept (the earliest of several), so that one wrong
// stamp costs one frame and not all that follow it. Of parts that are more than
// input_limits::longest_gap apart, the one with the most frames is kept, and those of several
// frames that follow or precede it within input_limits::longest_pause. The verdicts name `file`.
void refuse_out_of_order(const std::vector<Time>& stamps, const std::filesystem::path& file,
                         Verdicts& verdicts);

// Returns findings for the numbered files of `folder` beyond the last of `frames` stamps.
std::vector<Finding> files_without_stamp(const std::filesystem::path& folder, std::size_t frames);

}  // namespace maploop::sensors
