// Tells late measurements from broken clocks.
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/outcome.h"
#include "msgs/time.h"

namespace maploop::fusion {

// After 1970 and before 2100: differences of such stamps do not overflow.
bool plausible_stamp(Time stamp);

// A stamp older than the history is too late. One further ahead of all others than `confirm_gap`
// may be a fault, which would make all others look late: it is refused, and the next one is taken
// if it agrees with it (up to `max_gap`). When nothing but such refusals arrives, the clock of the
// data itself has jumped.
class StampGuard {
 public:
  explicit StampGuard(const FusionParameters& parameters);

  // Reason::none, out_of_range, too_old or time_jump.
  Reason check(Time stamp);
  void accept(Time stamp);
  // Call for each measurement refused for its stamp. True when the clock has jumped.
  bool refuse(Reason reason);
  void reset();

  Time newest() const { return newest_; }  // accepted; epoch 0: none
  Time oldest() const { return newest_ - history_length_; }

  template <class Archive>
  void archive(Archive& ar) {
    ar(newest_, unconfirmed_, refused_in_a_row_);
  }

 private:
  Duration history_length_;
  Duration confirm_gap_;
  Duration max_gap_;
  int restart_after_;
  Time newest_{};
  Time unconfirmed_{};  // the last stamp refused for being too far ahead
  int refused_in_a_row_ = 0;
};

}  // namespace maploop::fusion
