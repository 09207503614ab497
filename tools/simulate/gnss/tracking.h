// Simulates how a receiver tracks one signal that arrives by several paths.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "tools/simulate/gnss/signal_paths.h"
#include "tools/simulate/random.h"

namespace maploop::simulate {

struct SignalShape {
  double frequency = 0.0;  // Hz
  double chip = 0.0;       // m: half the width of the correlation's triangle
  double spacing = 0.0;    // between early and late correlator, in chips
  double cn0 = 0.0;        // dB-Hz at the zenith
};

// The measured value beyond straight range, clocks and atmosphere.
struct TrackedSignal {
  double code = 0.0;            // m, from paths and noise
  std::optional<double> phase;  // m, the same with whole cycles; empty: not locked
  double rate = 0.0;            // m/s
  double cn0 = 0.0;             // dB-Hz
  bool lost_lock = false;       // as the receiver reports it: it does not notice every slip
};

class SignalTracker {
 public:
  SignalTracker(const SignalShape& shape, std::uint64_t seed, std::uint64_t stream);

  // Tracks one epoch, `interval` seconds after the previous one. Returns nothing if the signal is
  // not tracked.
  std::optional<TrackedSignal> track(const std::vector<SignalPath>& paths, double elevation,
                                     double interval);

 private:
  bool slips(const SignalPath& strongest, double cn0, double interval);

  SignalShape shape_;
  double wavelength_;
  Random random_;
  bool tracked_ = false, locked_ = false;
  std::uint64_t surface_ = 0;  // of the strongest path
  std::int64_t cycles_ = 0;
};

// The scatterers of one satellite. Each stays for some tens of seconds and metres driven, then
// another replaces it; as the car moves, their paths become longer or shorter.
class Scatterers {
 public:
  Scatterers(std::uint64_t seed, std::uint64_t stream);

  // Advances by `interval` s at a speed in m/s, and appends the scatterers' paths to `paths`.
  void add_to(std::vector<SignalPath>& paths, double interval, double speed);

 private:
  struct Scatterer {
    SignalPath path;
    double share = 0.0;  // rate of the path's length as a share of the speed
  };
  Scatterer draw();

  Random random_;
  std::array<Scatterer, 3> scatterers_;
};

}  // namespace maploop::simulate
