// This file reads the stereo pairs of a drive from their files.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "msgs/image.h"
#include "sensors/replay/timestamps.h"
#include "sensors/source.h"

namespace maploop::sensors {

// These are the images of one camera: the files of a folder, or those of a video.
struct ImageFolder {
  std::filesystem::path data;  // the folder, or the video (has_video_name())
  Timestamps timestamps;
  // These are the files, relative to `data`, or the numbers of a video's images, from 0. If there
  // are none, the files are numbered PNG.
  std::vector<std::string> names = {};
  bool any_kind = false;               // also colour, 16 bits and JPEG
  std::vector<Finding> unpaired = {};  // images that are in no pair
};

// Pairs left and right images by number. One trigger exposes both, and the host stamps each a
// little later: stamp = the earlier of the two (against the scanner's clock it scatters by 0.3 ms
// on drive 0013, the left image's alone by 0.9 ms), available = the later + readout. A pair whose
// stamps differ by more than `max_skew` is refused, and so is an image that has another size
// than width x height. The pixels of pairs available up to `passed` are not read, for callers that
// skip them.
std::unique_ptr<Source<StereoPair>> make_stereo_source(ImageFolder left, ImageFolder right,
                                                       int width, int height, Duration readout,
                                                       Duration max_skew,
                                                       Time passed = Time::min());

}  // namespace maploop::sensors
