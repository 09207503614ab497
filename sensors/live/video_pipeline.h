// This file reads grey images of a camera through a GStreamer pipeline.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "msgs/image.h"
#include "sensors/clock/host_clock.h"
#include "sensors/live/connection.h"

namespace maploop::sensors {

// This is one image with the time at which the driver took it.
struct VideoFrame {
  GreyImage image;
  Time stamp{};    // the buffer's own, on the host's clock; the arrival if it has no stamp
  Time arrival{};  // when it was taken out of the pipeline
};

struct VideoState {
  ConnectionState connection;
  std::uint64_t frames = 0;
  std::uint64_t lost = 0;       // by the driver's numbers; includes images dropped here
  std::uint64_t unstamped = 0;  // images stamped with their arrival
};

// The description contains the elements that produce the images, as gst-launch-1.0 takes them:
// "v4l2src device=/dev/video0 ! ...". Opens automatically, and again after the camera was unplugged
// or has been silent for 3 s; a missing camera is not an error. At most four images are queued;
// then the oldest is dropped. Images that are not grey are converted. One thread at a time;
// pipelines have threads of their own.
class VideoPipeline {
 public:
  // Throws std::invalid_argument with GStreamer's message if the text is not a pipeline.
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
