// This file reads the images of a video file one after another.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "msgs/image.h"

namespace maploop::sensors {

// Returns whether the name ends like that of a video: .avi, .m4v, .mkv, .mov, .mp4 or .webm.
bool has_video_name(const std::filesystem::path& file);

// GStreamer decodes the file, as far as it has a decoder; colour becomes grey. Its threads decode
// at most four images ahead. One thread at a time may use an object.
class VideoFile {
 public:
  // Throws std::runtime_error that names the file if there is none.
  explicit VideoFile(const std::filesystem::path& file);
  ~VideoFile();
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  // Fills in image `number` of the file, from 0; those between it and the last one are decoded and
  // left out. Returns false behind the last image. Throws std::runtime_error with the reason if the
  // file is damaged there, or if the image was passed already.
  bool read(std::size_t number, GreyImage& image);

 private:
  struct Elements;
  std::unique_ptr<Elements> elements_;
  std::size_t next_ = 0;
};

}  // namespace maploop::sensors
