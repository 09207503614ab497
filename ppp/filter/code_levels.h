// Tracks how large the squared residuals of codes are relative to their expected variance, per
// satellite and over all satellites. A large ratio is a sign of reflected signals.
#pragma once

#include <optional>
#include <vector>

#include "ppp/satellite.h"

namespace maploop::ppp {

class CodeLevels {
 public:
  CodeLevels() : own_(satellite_slots) {}

  // Forgets all satellites; `level` becomes the level of all of them.
  void begin(double level);
  // Returns the level, which is at least 1, because a good code may have small residuals by chance.
  // A new satellite has the level of all.
  double of(Satellite satellite) const;

  // Takes the squared residual of a code divided by its usual variance; the ratio is clamped to
  // 100.
  void add(Satellite satellite, double ratio);
  // Call after the codes of each epoch: older values decay by exp(-interval/time), both in s.
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
