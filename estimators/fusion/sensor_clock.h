// Watches one sensor's own clock.
#pragma once

#include <cstdint>

#include "estimators/fusion/outcome.h"
#include "msgs/sample.h"

namespace maploop::fusion {

// A sensor counts its samples, and its stamps go on with the count. A later sample with an
// earlier stamp means that the clock has fallen back: what follows would look like late data,
// which it is not. From there on samples are refused until they are delivered as soon after their
// stamps as before. (Late data keeps the order of its stamps.) Where the earlier stamps are the
// ones delivered as usual, the clock was ahead until then and is right again: nothing is refused.
class SensorClock {
 public:
  // Reason::none or clock_fell_back.
  Reason check(const Sample& sample);

  template <class Archive>
  void archive(Archive& ar) {
    ar(last_stamp_, last_available_, last_sequence_, fallen_, believed_age_, usual_age_);
  }

 private:
  void follow(const Sample& sample);

  Time last_stamp_{};
  Time last_available_{};
  std::uint64_t last_sequence_ = 0;
  bool fallen_ = false;
  Duration believed_age_{};  // up to it, while fallen
  Duration usual_age_{};     // from stamp to delivery
};

}  // namespace maploop::fusion
