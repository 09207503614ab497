#include "sensors/live/video_pipeline.h"

#include <gst/app/gstappsink.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "sensors/live/gstreamer.h"

namespace maploop::sensors {
namespace {

constexpr Duration between_attempts = std::chrono::milliseconds(500);
constexpr Duration longest_silence = std::chrono::seconds(3);

GstOwned<GstElement> parse(const std::string& description) {
  return parse_pipeline(description +
                            " ! videoconvert ! video/x-raw,format=GRAY8 ! appsink name=maploop "
                            "max-buffers=4 drop=true sync=false",
                        description);
}

GstClockTime as_clock_time(Duration d) {
  return static_cast<GstClockTime>(std::max<std::int64_t>(0, d.count()));
}

}  // namespace

struct VideoPipeline::Elements {
  GstOwned<GstElement> pipeline;
  GstOwned<GstElement> sink;
  GstOwned<GstBus> bus;

  ~Elements() {
    if (pipeline) gst_element_set_state(pipeline.get(), GST_STATE_NULL);
  }
};

VideoPipeline::VideoPipeline(std::string description, const HostClock& clock)
    : description_(std::move(description)), clock_(clock) {
  parse(description_);
  state_.connection.problem = "is not open yet";
}

VideoPipeline::~VideoPipeline() = default;

void VideoPipeline::open() {
  auto elements = std::make_unique<Elements>();
  elements->pipeline = parse(description_);
  elements->sink.reset(gst_bin_get_by_name(GST_BIN(elements->pipeline.get()), "maploop"));
  elements->bus.reset(gst_element_get_bus(elements->pipeline.get()));
  // A source may take long to open a device or to reach a host, so it starts asynchronously.
  gst_element_call_async(
      elements->pipeline.get(),
      [](GstElement* pipeline, gpointer) { gst_element_set_state(pipeline, GST_STATE_PLAYING); },
      nullptr, nullptr);
  elements_ = std::move(elements);
  heard_ = clock_.now();
  next_number_ = 0;
}

void VideoPipeline::close(std::string problem) {
  elements_.reset();
  state_.connection.open = false;
  state_.connection.problem = std::move(problem);
  next_attempt_ = clock_.now() + between_attempts;
}

// Returns false if the pipeline has ended.
bool VideoPipeline::heed_messages() {
  constexpr auto ends = static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS);
  const GstOwned<GstMessage> message(gst_bus_pop_filtered(elements_->bus.get(), ends));
  if (message == nullptr) {
    if (clock_.now() - heard_ <= longest_silence) return true;
    close("sends no images");
    return false;
  }
  std::string problem = "has ended";
  if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_ERROR)
    problem = "has failed: " + error_text(message.get());
  close(std::move(problem));
  return false;
}

bool VideoPipeline::read(VideoFrame& frame, Duration patience) {
  if (elements_ == nullptr) {
    const Duration left = next_attempt_ - clock_.now();
    if (left > Duration::zero()) {
      std::this_thread::sleep_for(std::min(left, patience));
      return false;
    }
    open();
  }
  const GstOwned<GstSample> sample(
      gst_app_sink_try_pull_sample(GST_APP_SINK(elements_->sink.get()), as_clock_time(patience)));
  if (sample == nullptr) {
    heed_messages();
    return false;
  }
  take(frame, sample.get());
  return !frame.image.empty();
}

void VideoPipeline::take(VideoFrame& frame, void* opaque) {
  auto* sample = static_cast<GstSample*>(opaque);
  frame.arrival = frame.stamp = heard_ = clock_.now();
  if (!state_.connection.open) {
    state_.connection.open = true;
    ++state_.connection.opened;
    state_.connection.problem.clear();
  }
  copy_grey(sample, frame.image);
  if (frame.image.empty()) return;
  ++state_.frames;
  state_.connection.bytes += frame.image.pixels.size();

  // The age of the image is the pipeline's clock now minus the time of the buffer.
  GstBuffer* buffer = gst_sample_get_buffer(sample);
  GstElement* pipeline = elements_->pipeline.get();
  const GstOwned<GstClock> clock(gst_element_get_clock(pipeline));
  const GstClockTime pts = GST_BUFFER_PTS(buffer);
  bool stamped = clock != nullptr && GST_CLOCK_TIME_IS_VALID(pts);
  if (stamped) {
    const auto age = static_cast<std::int64_t>(gst_clock_get_time(clock.get())) -
                     static_cast<std::int64_t>(gst_element_get_base_time(pipeline) + pts);
    stamped = age >= 0 && Duration(age) < longest_silence;
    if (stamped) frame.stamp = frame.arrival - Duration(age);
  }
  if (!stamped) ++state_.unstamped;

  if (const guint64 number = GST_BUFFER_OFFSET(buffer); number != GST_BUFFER_OFFSET_NONE) {
    if (next_number_ > 0 && number > next_number_) state_.lost += number - next_number_;
    next_number_ = number + 1;
  }
}

}  // namespace maploop::sensors
