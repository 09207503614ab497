// Stereo pairs into a GStreamer pipeline: what a camera would send.
#pragma once

#include <memory>
#include <string>

#include "msgs/image.h"

namespace maploop::sensors {

// Both images side by side, as one grey image, into elements as gst-launch-1.0 takes them:
// "rtpgstpay ! udpsink host=127.0.0.1 port=5004". For one thread at a time.
class VideoSender {
 public:
  // Throws std::invalid_argument where the text is no pipeline, std::runtime_error where it does
  // not start: what GStreamer says of it.
  VideoSender(const std::string& elements, int width, int height, double frames_a_second);
  ~VideoSender();  // waits at most a second for what is still on its way
  VideoSender(const VideoSender&) = delete;
  VideoSender& operator=(const VideoSender&) = delete;

  // With the moment `ago` before now as the image's own: when it was due, however late it is sent.
  // False where the pipeline has failed.
  bool send(const StereoPair& pair, Duration ago);

 private:
  struct Elements;
  std::unique_ptr<Elements> elements_;
  int width_, height_;
};

}  // namespace maploop::sensors
