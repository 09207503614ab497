#include "sensors/replay/stereo_source.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "msgs/input_limits.h"
#include "sensors/image/jpeg.h"
#include "sensors/image/png.h"
#include "sensors/image/video_file.h"
#include "sensors/replay/frame_source.h"

namespace maploop::sensors {
namespace {

struct StereoFrames {
  FrameList list;
  std::vector<Time> stamps;
};

StereoFrames judge(const ImageFolder& left_folder, const ImageFolder& right_folder,
                   Duration readout, Duration max_skew) {
  const Timestamps& left = left_folder.timestamps;
  const Timestamps& right = right_folder.timestamps;
  StereoFrames frames;
  const std::size_t count = std::max(left.size(), right.size());
  frames.stamps.resize(count);
  frames.list.available.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    auto found = verdict(left, i);
    if (!found) found = verdict(right, i);
    if (!found) {
      const auto [earlier, later] = std::minmax(left.stamps[i], right.stamps[i]);
      frames.stamps[i] = earlier;
      frames.list.available[i] = later + readout;
      const Duration skew = later - earlier;
      if (skew > max_skew) {
        found = Finding{right.file.string(), i + 1,
                        "differs from the left image's stamp by " +
                            std::to_string(to_seconds(skew)) + " s, more than max_pair_skew"};
      }
    }
    frames.list.verdicts.push_back(std::move(found));
  }
  refuse_out_of_order(frames.stamps, left.file, frames.list.verdicts);
  refuse_out_of_order(frames.list.available, right.file, frames.list.verdicts);
  for (const ImageFolder* folder : {&left_folder, &right_folder}) {
    auto found =
        folder->names.empty() ? files_without_stamp(folder->data, count) : folder->unpaired;
    frames.list.unstamped.insert(frames.list.unstamped.end(), found.begin(), found.end());
  }
  return frames;
}

// Reads the images of one camera.
struct Camera {
  ImageFolder folder;
  std::unique_ptr<VideoFile> video = nullptr;  // opened with its first image
};

class StereoSource final : public FrameSource<StereoPair> {
 public:
  StereoSource(ImageFolder left, ImageFolder right, StereoFrames frames, int width, int height,
               Time passed)
      : FrameSource(std::move(frames.list), passed),
        left_{std::move(left)},
        right_{std::move(right)},
        stamps_(std::move(frames.stamps)),
        width_(width),
        height_(height) {}

 private:
  bool read(std::size_t i, StereoPair& pair) override {
    if (!read_image(left_, i, pair.left) || !read_image(right_, i, pair.right)) return false;
    if (i + 1 == stamps_.size())
      for (Camera* camera : {&left_, &right_}) refuse_the_rest(*camera);
    return true;
  }

  void set_stamps(std::size_t i, StereoPair& pair) const override { pair.stamp = stamps_[i]; }

  bool read_image(Camera& camera, std::size_t i, GreyImage& image) {
    const ImageFolder& folder = camera.folder;
    if (has_video_name(folder.data)) return read_video(camera, i, image);
    const auto file =
        folder.data / (folder.names.empty() ? numbered_file(i, ".png") : folder.names[i]);
    return read_and_parse(file, input_limits::picture, [&](const std::vector<char>& bytes) {
      if (!folder.any_kind) return decode_grey_png(bytes, width_, height_, image);
      image = is_png(bytes) ? decode_any_png(bytes) : decode_grey_jpeg(bytes);
      require_size(image);
    });
  }

  bool read_video(Camera& camera, std::size_t i, GreyImage& image) {
    const ImageFolder& folder = camera.folder;
    try {
      if (!camera.video) camera.video = std::make_unique<VideoFile>(folder.data);
      if (!camera.video->read(std::stoul(folder.names[i]), image)) {
        throw std::runtime_error("the video ended before this image, but '" +
                                 folder.timestamps.file.string() + "' has a stamp for it");
      }
      require_size(image);
      return true;
    } catch (const std::exception& error) {
      report_.refuse({(folder.data / folder.names[i]).string(), 0, error.what()});
      return false;
    }
  }

  // A video that goes on behind the last stamp was perhaps stamped by the list of another one.
  void refuse_the_rest(Camera& camera) {
    const ImageFolder& folder = camera.folder;
    if (!camera.video || !folder.unpaired.empty()) return;
    try {
      GreyImage rest;
      if (!camera.video->read(std::stoul(folder.names.back()) + 1, rest)) return;
      report_.refuse({folder.data.string(), 0,
                      "has more images than '" + folder.timestamps.file.string() +
                          "' has stamps; check that the stamps belong to this video"});
    } catch (const std::exception& error) {
      report_.refuse({folder.data.string(), 0, error.what()});
    }
  }

  void require_size(const GreyImage& image) const {
    if (image.width == width_ && image.height == height_) return;
    throw std::runtime_error("the image is " + std::to_string(image.width) + " x " +
                             std::to_string(image.height) + ", but the calibration states " +
                             std::to_string(width_) + " x " + std::to_string(height_));
  }

  Camera left_, right_;
  std::vector<Time> stamps_;
  int width_, height_;
};

}  // namespace

std::unique_ptr<Source<StereoPair>> make_stereo_source(ImageFolder left, ImageFolder right,
                                                       int width, int height, Duration readout,
                                                       Duration max_skew, Time passed) {
  StereoFrames frames = judge(left, right, readout, max_skew);
  return std::make_unique<StereoSource>(std::move(left), std::move(right), std::move(frames), width,
                                        height, passed);
}

}  // namespace maploop::sensors
