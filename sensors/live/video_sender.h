// This file sends stereo pairs into a GStreamer pipeline, as a camera would.
#pragma once

#include <memory>
#include <string>

#include "msgs/image.h"

namespace maploop::sensors {

// Sends both images side by side, as one grey image, to elements as gst-launch-1.0 takes them:
// "rtpgstpay ! udpsink host=127.0.0.1 port=5004". One thread at a time.
class VideoSender {
 public:
  // Throws std::invalid_argument if the text is not a pipeline and std::runtime_error if it does
  // not start, each with GStreamer's message.
  VideoSender(const std::string& elements, int width, int height, double frames_a_second);
  ~VideoSender();  // waits at most a second for data still in the pipeline
  VideoSender(const VideoSender&) = delete;
  VideoSender& operator=(const VideoSender&) = delete;

  // Stamps the image with the moment `ago` before now: when it was due, however late it is sent.
  // Returns false if the pipeline has failed, or an image is not of the given size.
  bool send(const StereoPair& pair, Duration ago);

 private:
  struct Elements;
  std::unique_ptr<Elements> elements_;
  int width_, height_;
};

}  // namespace maploop::sensors
