#include "sensors/image/video_file.h"

#include <gst/app/gstappsink.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "sensors/live/gstreamer.h"

namespace maploop::sensors {
namespace {

constexpr GstClockTime patience = 100 * GST_MSECOND;    // between looks for an error
constexpr GstClockTime longest_wait = 20 * GST_SECOND;  // for an image of a file on a slow disk

}  // namespace

bool has_video_name(const std::filesystem::path& file) {
  constexpr auto ends =
      std::to_array<const char*>({".avi", ".m4v", ".mkv", ".mov", ".mp4", ".webm"});
  return std::ranges::find(ends, file.extension().string()) != ends.end();
}

struct VideoFile::Elements {
  GstOwned<GstElement> pipeline = parse_pipeline(
      "filesrc name=file ! decodebin ! videoconvert ! "
      "video/x-raw,format=GRAY8,width=[1,16384],height=[1,16384] ! "
      "appsink name=images max-buffers=4 sync=false",
      "the decoder of videos");
  GstOwned<GstElement> sink{gst_bin_get_by_name(GST_BIN(pipeline.get()), "images")};
  GstOwned<GstBus> bus{gst_element_get_bus(pipeline.get())};
  std::string problem;  // why there are no more images

  explicit Elements(const std::filesystem::path& file) {
    const GstOwned<GstElement> source(gst_bin_get_by_name(GST_BIN(pipeline.get()), "file"));
    g_object_set(source.get(), "location", file.c_str(), nullptr);
    gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  }
  ~Elements() { gst_element_set_state(pipeline.get(), GST_STATE_NULL); }
  Elements(const Elements&) = delete;
  Elements& operator=(const Elements&) = delete;

  // Returns nothing at the end of the file.
  GstOwned<GstSample> next() {
    GstAppSink* images = GST_APP_SINK(sink.get());
    for (GstClockTime waited = 0; problem.empty(); waited += patience) {
      GstOwned<GstSample> sample(gst_app_sink_try_pull_sample(images, patience));
      if (sample || gst_app_sink_is_eos(images)) return sample;
      const GstOwned<GstMessage> failed(gst_bus_pop_filtered(bus.get(), GST_MESSAGE_ERROR));
      if (failed) {
        problem = "it cannot be decoded: " + error_text(failed.get()) +
                  " (the package gstreamer1.0-libav decodes most videos)";
      } else if (waited >= longest_wait) {
        problem = "its decoder gives no more images";
      }
    }
    throw std::runtime_error(problem);
  }
};

VideoFile::VideoFile(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    throw std::runtime_error("the video '" + file.string() + "' is not a file");
  elements_ = std::make_unique<Elements>(file);
}

VideoFile::~VideoFile() = default;

bool VideoFile::read(std::size_t number, GreyImage& image) {
  if (number < next_)
    throw std::runtime_error("image " + std::to_string(number) + " was passed already");
  GstOwned<GstSample> sample;
  for (; next_ <= number; ++next_) {
    sample = elements_->next();
    if (!sample) return false;
  }
  copy_grey(sample.get(), image);
  if (image.empty()) throw std::runtime_error("image " + std::to_string(number) + " is empty");
  return true;
}

}  // namespace maploop::sensors
