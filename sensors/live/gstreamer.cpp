#include "sensors/live/gstreamer.h"

#include <gst/video/video.h>

#include <cstring>
#include <stdexcept>

#include "sensors/live/endpoint.h"

namespace maploop::sensors {

GstOwned<GstElement> parse_pipeline(const std::string& whole, const std::string& given) {
  static const bool ready = (gst_init(nullptr, nullptr), true);
  static_cast<void>(ready);
  GError* raw_error = nullptr;
  GstElement* pipeline =
      gst_parse_launch_full(whole.c_str(), nullptr, GST_PARSE_FLAG_FATAL_ERRORS, &raw_error);
  const GstOwned<GError> error(raw_error);
  if (pipeline == nullptr) {
    throw std::invalid_argument(
        "'" + without_secrets(given) +
        "' is not a pipeline: " + (error ? without_secrets(error->message) : "it is empty") +
        "; test it with gst-launch-1.0; gst-inspect-1.0 lists the elements");
  }
  // The reference is floating: it has no owner until it is sunk.
  return GstOwned<GstElement>(GST_ELEMENT(gst_object_ref_sink(pipeline)));
}

std::string error_text(GstMessage* message) {
  GError* error = nullptr;
  gst_message_parse_error(message, &error, nullptr);
  const GstOwned<GError> owned(error);
  return without_secrets(error->message);
}

void copy_grey(GstSample* sample, GreyImage& image) {
  image.resize(0, 0);
  GstBuffer* buffer = gst_sample_get_buffer(sample);
  GstVideoInfo info;
  GstVideoFrame video;
  if (buffer == nullptr || !gst_video_info_from_caps(&info, gst_sample_get_caps(sample)) ||
      !gst_video_frame_map(&video, &info, buffer, GST_MAP_READ)) {
    return;
  }
  image.resize(GST_VIDEO_FRAME_WIDTH(&video), GST_VIDEO_FRAME_HEIGHT(&video));
  const auto* row = static_cast<const std::uint8_t*>(GST_VIDEO_FRAME_PLANE_DATA(&video, 0));
  const auto width = static_cast<std::size_t>(image.width);
  for (int y = 0; y < image.height; ++y) {
    std::memcpy(image.pixels.data() + static_cast<std::size_t>(y) * width, row, width);
    row += GST_VIDEO_FRAME_PLANE_STRIDE(&video, 0);
  }
  gst_video_frame_unmap(&video);
}

}  // namespace maploop::sensors
