#include "sensors/live/video_sender.h"

#include <gst/app/gstappsrc.h>

#include <algorithm>
#include <stdexcept>

#include "sensors/live/gstreamer.h"

namespace maploop::sensors {

struct VideoSender::Elements {
  GstOwned<GstElement> pipeline;
  GstOwned<GstElement> source;
  GstOwned<GstBus> bus;

  // Returns the running time of the pipeline at the moment `ago` before now; 0 before its start.
  GstClockTime running_time(Duration ago) const {
    const GstOwned<GstClock> clock(gst_element_get_clock(pipeline.get()));
    if (clock == nullptr) return 0;
    const auto now = static_cast<std::int64_t>(gst_clock_get_time(clock.get()) -
                                               gst_element_get_base_time(pipeline.get()));
    return static_cast<GstClockTime>(std::max<std::int64_t>(0, now - ago.count()));
  }

  ~Elements() {
    if (!source) return;
    gst_app_src_end_of_stream(GST_APP_SRC(source.get()));
    constexpr auto ends = static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS);
    const GstOwned<GstMessage> end(gst_bus_timed_pop_filtered(bus.get(), GST_SECOND, ends));
    gst_element_set_state(pipeline.get(), GST_STATE_NULL);
  }
};

VideoSender::VideoSender(const std::string& elements, int width, int height, double frames_a_second)
    : width_(width), height_(height) {
  const std::string caps = "video/x-raw,format=GRAY8,width=" + std::to_string(2 * width) +
                           ",height=" + std::to_string(height) + ",framerate=" +
                           std::to_string(static_cast<int>(1000.0 * frames_a_second)) + "/1000";
  const std::string whole =
      "appsrc name=maploop is-live=true format=time caps=" + caps + " ! " + elements;
  auto made = std::make_unique<Elements>();
  made->pipeline = parse_pipeline(whole, elements);
  made->source.reset(gst_bin_get_by_name(GST_BIN(made->pipeline.get()), "maploop"));
  made->bus.reset(gst_element_get_bus(made->pipeline.get()));
  if (gst_element_set_state(made->pipeline.get(), GST_STATE_PLAYING) == GST_STATE_CHANGE_FAILURE) {
    const GstOwned<GstMessage> message(gst_bus_pop_filtered(made->bus.get(), GST_MESSAGE_ERROR));
    throw std::runtime_error("'" + elements + "' does not start" +
                             (message ? ": " + error_text(message.get()) : std::string()));
  }
  elements_ = std::move(made);
}

VideoSender::~VideoSender() = default;

bool VideoSender::send(const StereoPair& pair, Duration ago) {
  const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  for (const GreyImage* image : {&pair.left, &pair.right}) {
    if (image->width != width_ || image->height != height_) return false;
  }
  // Rows of raw video are padded to a multiple of four bytes.
  const std::size_t stride = (2 * width + 3) / 4 * 4;
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, stride * height, nullptr);
  GstMapInfo map;
  if (buffer == nullptr || !gst_buffer_map(buffer, &map, GST_MAP_WRITE)) return false;
  for (std::size_t y = 0; y < height; ++y) {
    guint8* row = map.data + y * stride;
    std::copy_n(pair.left.pixels.data() + y * width, width, row);
    std::copy_n(pair.right.pixels.data() + y * width, width, row + width);
  }
  gst_buffer_unmap(buffer, &map);
  GST_BUFFER_PTS(buffer) = elements_->running_time(ago);
  return gst_app_src_push_buffer(GST_APP_SRC(elements_->source.get()), buffer) == GST_FLOW_OK;
}

}  // namespace maploop::sensors
