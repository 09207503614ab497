// This class checks one sensor's own clock.
#pragma once

#include <cstdint>

#include "estimators/fusion/outcome.h"
#include "msgs/sample.h"

namespace maploop::fusion {

// A sensor numbers its samples, and their stamps increase with the number. A later sample with an
// earlier stamp means that the clock went back; the samples after it would look like late data.
// (Late data keeps the order of its stamps.) From then on samples are refused until their age at
// delivery is as small as before. If instead the earlier stamps have the usual age, the clock was
// ahead before and is now right: nothing is refused.
class SensorClock {
 public:
  // Returns Reason::none or clock_fell_back.
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
  Duration believed_age_{};  // while fallen_: samples up to this age are accepted again
  Duration usual_age_{};     // usual time from stamp to delivery
};

}  // namespace maploop::fusion
