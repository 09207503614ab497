// A caller that has a clock measures each stage of a pair here; the odometry reads no clock.
#pragma once

#include <functional>
#include <string_view>

namespace maploop::stereo {

// The listener is called with a stage's name when the stage ends, on the thread that runs it.
using StageListener = std::function<void(std::string_view stage)>;

inline void notify(const StageListener& listener, std::string_view stage) {
  if (listener) listener(stage);
}

}  // namespace maploop::stereo
