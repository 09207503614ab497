// The guard distinguishes late measurements from broken clocks.
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/outcome.h"
#include "msgs/time.h"

namespace maploop::fusion {

// Returns whether the stamp is after 1970 and before 2100; differences of such stamps do not
// overflow.
bool plausible_stamp(Time stamp);

// A stamp older than the history is too old. A stamp ahead of all others by more than `confirm_gap`
// may be a fault that would make all other data look late. It is refused, and the next stamp is
// accepted if it is within `confirm_gap` of it and at most `max_gap` ahead, or if it is as far
// after it as it was after the others, at most half of `max_gap`: with rarer data alone the filter
// does not find its way through a bend. In the latter case the data is rare, as the fixes of a slow
// receiver alone: from then on `confirm_gap` is half as long again as their interval, and `max_gap`
// is at least four intervals. If only such refusals arrive, the clock of the data itself has
// jumped.
class StampGuard {
 public:
  explicit StampGuard(const FusionParameters& parameters);

  // Returns Reason::none, out_of_range, too_old or time_jump.
  Reason check(Time stamp);
  void accept(Time stamp);
  // Call this for each measurement refused for its stamp. Returns true if the clock has jumped.
  bool refuse(Reason reason);
  void reset();

  Time newest() const { return newest_; }  // newest accepted stamp; epoch 0: none
  Time oldest() const { return newest_ - history_length_; }

  template <class Archive>
  void archive(Archive& ar) {
    ar(newest_, unconfirmed_, interval_, refused_in_a_row_);
  }

 private:
  Duration usual_gap() const;

  Duration history_length_;
  Duration confirm_gap_;
  Duration max_gap_;
  int restart_after_;
  Time newest_{};
  Time unconfirmed_{};   // the last stamp refused for being too far ahead
  Duration interval_{};  // between recent stamps; a longest one is halved by each shorter one
  int refused_in_a_row_ = 0;
};

}  // namespace maploop::fusion
