// Grey images of a camera, by a GStreamer pipeline.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "msgs/image.h"
#include "sensors/clock/host_clock.h"
#include "sensors/live/connection.h"

namespace maploop::sensors {

// One image, and when the driver says that it was taken.
struct VideoFrame {
  GreyImage image;
  Time stamp{};    // the buffer's own, on the host's clock; its arrival where it has none
  Time arrival{};  // when it was taken out of the pipeline
};

struct VideoState {
  ConnectionState connection;
  std::uint64_t frames = 0;
  std::uint64_t lost = 0;       // by the numbers of the driver; those dropped here among them
  std::uint64_t unstamped = 0;  // stamped when they came
};

// Elements up to the images, as gst-launch-1.0 takes them: "v4l2src device=/dev/video0 ! ...".
// Opens by itself, and again where the camera was unplugged, or has been silent for 3 s; missing it
// is no error. At most four images wait; of more the oldest is dropped. What is not grey is
// converted. One thread at a time; pipelines have threads of their own.
class VideoPipeline {
 public:
  // Throws std::invalid_argument where the text is no pipeline: what GStreamer says of it.
  VideoPipeline(std::string description, const HostClock& clock);
  ~VideoPipeline();
  VideoPipeline(const VideoPipeline&) = delete;
  VideoPipeline& operator=(const VideoPipeline&) = delete;

  // Waits at most `patience` for the next image, and fills it in place.
  bool read(VideoFrame& frame, Duration patience);

  const std::string& description() const { return description_; }
  const VideoState& state() const { return state_; }

 private:
  struct Elements;

  void open();
  void close(std::string problem);
  bool heed_messages();
  void take(VideoFrame& frame, void* sample);

  std::string description_;
  const HostClock& clock_;
  VideoState state_;
  std::unique_ptr<Elements> elements_;
  Time next_attempt_{};
  Time heard_{};
  std::uint64_t next_number_ = 0;
};

}  // namespace maploop::sensors
