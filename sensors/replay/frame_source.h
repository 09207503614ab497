// This file reads a recording that has one or a few numbered files for each frame.
#pragma once

#include <cstddef>
#include <exception>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "msgs/time.h"
#include "sensors/replay/files.h"
#include "sensors/replay/timestamps.h"
#include "sensors/source.h"

namespace maploop::sensors {

// This lists the frames of a recording by number, with the verdict on each.
struct FrameList {
  Verdicts verdicts;
  std::vector<Time> available;     // one for each verdict
  std::vector<Finding> unstamped;  // files beyond the last stamp
};

// Goes through the frames in order: refuses those with a verdict and reads the others. Frames
// available up to `passed` get their stamps only, for callers that skip them.
template <class Frame>
class FrameSource : public Source<Frame> {
 public:
  bool next(Frame& frame) final {
    while (index_ < frames_.verdicts.size()) {
      const std::size_t i = index_++;
      if (frames_.verdicts[i]) {
        report_.refuse(*frames_.verdicts[i]);
        continue;
      }
      if (frames_.available[i] > passed_ && !read(i, frame)) continue;
      set_stamps(i, frame);
      frame.available = frames_.available[i];
      frame.sequence = i;
      ++report_.delivered;
      return true;
    }
    for (Finding& finding : frames_.unstamped) report_.refuse(std::move(finding));
    frames_.unstamped.clear();
    return false;
  }

  const SourceReport& report() const final { return report_; }

 protected:
  FrameSource(FrameList frames, Time passed) : frames_(std::move(frames)), passed_(passed) {}

  // Fills the content; returns false if the frame is refused.
  virtual bool read(std::size_t i, Frame& frame) = 0;
  virtual void set_stamps(std::size_t i, Frame& frame) const = 0;

  // Reads a file of at most `largest` bytes and calls `parse(bytes)`. Any exception of either
  // refuses the frame.
  template <class Parse>
  bool read_and_parse(const std::filesystem::path& file, std::size_t largest, Parse parse) {
    try {
      read_bytes(file, largest, bytes_);
      parse(bytes_);
      return true;
    } catch (const FileError& error) {
      report_.refuse({file.string(), 0, error.reason()});
      return false;
    } catch (const std::exception& error) {
      report_.refuse({file.string(), 0, error.what()});
      return false;
    }
  }

  SourceReport report_;

 private:
  FrameList frames_;
  Time passed_;
  std::size_t index_ = 0;
  std::vector<char> bytes_;
};

}  // namespace maploop::sensors
