// Keeps the epochs of a file in the order of time where some of them have wrong dates.
#pragma once

#include <vector>

#include "ppp/readers/files/lines.h"
#include "ppp/readers/streams/epoch_builder.h"

namespace maploop::ppp {

// Epochs that are not after those before them are held until it is known which of both are wrong:
// those held are believed once they are more than the epochs they contradict, and at least three,
// or if the file ends there. The others are refused.
class EpochSequence {
 public:
  // Epochs go to the end of `observations`, which must outlive this, as `lines` must.
  EpochSequence(Observations& observations, const Lines& lines)
      : observations_(observations), lines_(lines) {}

  // Takes the content of an epoch, which ends at the current line, and leaves it empty.
  void add(Epoch& epoch);
  // Decides about those that are held at the end of the file.
  void finish();

 private:
  struct Held {
    Epoch epoch;
    int line = 0;
  };

  // Returns how many epochs are not before the first one that is held.
  std::size_t contradicted() const;
  void refuse_held();
  void believe_held();

  Observations& observations_;
  const Lines& lines_;
  std::vector<Held> held_;     // in the order of time
  bool power_failed_ = false;  // at an epoch that was refused since the last one kept
};

}  // namespace maploop::ppp
