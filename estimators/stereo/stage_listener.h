// Where the time of a pair goes, for whoever has a clock: the odometry has none.
#pragma once

#include <functional>
#include <string_view>

namespace maploop::stereo {

// Called with a stage's name when it ends, on the thread that runs it.
using StageListener = std::function<void(std::string_view stage)>;

inline void notify(const StageListener& listener, std::string_view stage) {
  if (listener) listener(stage);
}

}  // namespace maploop::stereo
