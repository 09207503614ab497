#include "sensors/replay/timestamps.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <system_error>

#include "msgs/input_limits.h"
#include "sensors/number.h"
#include "sensors/replay/files.h"

namespace maploop::sensors {
namespace {

// Keeps the frames of an increasing subsequence of length `wanted`; run[i] is the length of the
// longest one that starts at frame i.
void leave_out_of_order(const std::vector<Time>& stamps, const std::filesystem::path& file,
                        const std::vector<std::size_t>& run, std::size_t wanted,
                        Verdicts& verdicts) {
  const Time* last = nullptr;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (verdicts[i]) continue;
    if (run[i] == wanted && (last == nullptr || *last < stamps[i])) {
      last = &stamps[i];
      --wanted;
    } else {
      verdicts[i] = Finding{file.string(), i + 1,
                            "time does not increase: " + format_time(stamps[i]) +
                                " is out of order among its neighbours"};
    }
  }
}

// A part is a run of frames without a gap longer than any recording has.
struct Part {
  std::size_t begin = 0, end = 0, frames = 0;
  Time first{}, last{};
};

std::vector<Part> parts_of(const std::vector<Time>& stamps, const Verdicts& verdicts) {
  std::vector<Part> parts;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (verdicts[i]) continue;
    if (parts.empty() ||
        !input_limits::within(input_limits::longest_gap, parts.back().last, stamps[i]))
      parts.push_back({i, i, 0, stamps[i], stamps[i]});
    parts.back().end = i + 1;
    parts.back().last = stamps[i];
    ++parts.back().frames;
  }
  return parts;
}

// Takes increasing stamps. Keeps the part with the most frames (the earliest of several), and the
// parts before and after it that a pause of the recording explains. A single stamp does not show a
// pause.
void leave_out_of_reach(const std::vector<Time>& stamps, const std::filesystem::path& file,
                        Verdicts& verdicts) {
  std::vector<Part> parts = parts_of(stamps, verdicts);
  if (parts.empty()) return;
  const auto fewer = [](const Part& a, const Part& b) { return a.frames < b.frames; };
  const Part most = *std::max_element(parts.begin(), parts.end(), fewer);
  std::erase_if(parts, [&](const Part& p) { return p.frames == 1 && p.begin != most.begin; });
  const auto pause = [](const Part& a, const Part& b) {
    return input_limits::within(input_limits::longest_pause, a.last, b.first);
  };
  auto first = std::find_if(parts.begin(), parts.end(),
                            [&](const Part& p) { return p.begin == most.begin; });
  auto last = first;
  while (first != parts.begin() && pause(*std::prev(first), *first)) --first;
  while (std::next(last) != parts.end() && pause(*last, *std::next(last))) ++last;
  std::vector<bool> kept(stamps.size(), false);
  for (auto part = first; part != std::next(last); ++part) {
    std::fill(kept.begin() + static_cast<std::ptrdiff_t>(part->begin),
              kept.begin() + static_cast<std::ptrdiff_t>(part->end), true);
  }
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (verdicts[i] || kept[i]) continue;
    verdicts[i] = Finding{file.string(), i + 1,
                          format_time(stamps[i]) + " is more than an hour from the other stamps"};
  }
}

}  // namespace

Timestamps parse_timestamps(std::string_view text, const std::filesystem::path& file) {
  if (static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) > input_limits::frames) {
    throw std::runtime_error("'" + file.string() + "' has more than " +
                             std::to_string(input_limits::frames) +
                             " lines; restore the file from KITTI's archive");
  }
  Timestamps result{file, {}, {}};
  bool any = false;
  for (const std::string_view line : split_lines(text)) {
    Time stamp{};
    std::optional<Finding> verdict;
    try {
      stamp = parse_time(line);
      any = true;
    } catch (const std::invalid_argument&) {
      verdict =
          Finding{file.string(), result.size() + 1,
                  "not a time stamp of the form YYYY-MM-DD hh:mm:ss.fraction: " + quoted(line)};
    }
    result.stamps.push_back(stamp);
    result.verdicts.push_back(std::move(verdict));
  }
  if (!any) {
    throw std::runtime_error("'" + file.string() +
                             "' contains no time stamp; restore the file from KITTI's archive");
  }
  return result;
}

Timestamps read_timestamps(const std::filesystem::path& file) {
  try {
    return parse_timestamps(read_text(file), file);
  } catch (const FileError& error) {
    throw std::runtime_error("time stamps '" + file.string() + "': " + error.reason() +
                             "; restore the file from KITTI's archive");
  }
}

std::optional<Finding> verdict(const Timestamps& timestamps, std::size_t i) {
  if (i < timestamps.size()) return timestamps.verdicts[i];
  return Finding{timestamps.file.string(), i + 1, "the file ends before this line"};
}

void refuse_out_of_order(const std::vector<Time>& stamps, const std::filesystem::path& file,
                         Verdicts& verdicts) {
  // run[i] is the length of the longest increasing subsequence that starts at frame i, found by the
  // patience method from the end; heads[n] is the latest start of one of length n + 1.
  std::vector<std::size_t> run(stamps.size(), 0);
  std::vector<Time> heads;
  for (std::size_t i = stamps.size(); i-- > 0;) {
    if (verdicts[i]) continue;
    const auto head = std::lower_bound(heads.begin(), heads.end(), stamps[i], std::greater<>());
    run[i] = static_cast<std::size_t>(head - heads.begin()) + 1;
    if (head == heads.end()) {
      heads.push_back(stamps[i]);
    } else {
      *head = stamps[i];
    }
  }
  leave_out_of_order(stamps, file, run, heads.size(), verdicts);
  leave_out_of_reach(stamps, file, verdicts);
}

std::vector<Finding> files_without_stamp(const std::filesystem::path& folder, std::size_t frames) {
  std::vector<Finding> findings;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string stem = entry->path().stem().string();
    const auto index = parse_number<std::size_t>(stem);
    if (!index || *index < frames) continue;
    findings.push_back(
        {entry->path().string(), 0,
         "has no time stamp: the file of time stamps has only " + std::to_string(frames)});
  }
  std::sort(findings.begin(), findings.end(),
            [](const Finding& a, const Finding& b) { return a.file < b.file; });
  return findings;
}

}  // namespace maploop::sensors
