// How large the residuals of codes are, squared, against what is expected of them: of each
// satellite, and of all. Reflected signals are the reason where it is large.
#pragma once

#include <optional>
#include <vector>

#include "ppp/satellite.h"

namespace maploop::ppp {

class CodeLevels {
 public:
  CodeLevels() : own_(satellite_slots) {}

  // Nothing is known of the satellites; `level` of them all.
  void begin(double level);
  // At least 1, for a good code may be so by chance. Of a new satellite what it is of all.
  double of(Satellite satellite) const;

  // A code's residual, squared, in its usual variance; at 100 it ends to count.
  void add(Satellite satellite, double ratio);
  // After an epoch's: what has been `interval` s is remembered by exp(-interval/time).
  void end_epoch(double interval, double time);

  template <class Archive>
  void archive(Archive& ar) {
    ar(own_, all_);
  }

 private:
  struct Level {
    std::optional<double> mean;  // over time
    std::optional<double> last;  // of this epoch
    template <class Archive>
    void archive(Archive& ar) {
      ar(mean);
    }
  };
  std::vector<Level> own_;
  double all_ = 1.0;
};

}  // namespace maploop::ppp
