#include "tools/simulate/gnss/tracking.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "ppp/satellite.h"

namespace maploop::simulate {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;
constexpr double weakest_tracked = 23.0, weakest_acquired = 29.0;  // dB-Hz
constexpr double code_bandwidth = 0.5, phase_bandwidth = 12.0;     // Hz

using Complex = std::complex<double>;

// Returns the correlation of the received sum with a replica delayed by `delay` (m), `ahead`
// seconds later.
Complex correlation(const std::vector<SignalPath>& paths, const SignalShape& shape,
                    double wavelength, double delay, double ahead) {
  Complex sum = 0.0;
  for (const SignalPath& p : paths) {
    const double overlap = 1.0 - std::fabs(delay - p.delay) / shape.chip;
    if (overlap <= 0.0) continue;
    const double phase = p.phase - two_pi * (p.delay + p.rate * ahead) / wavelength;
    sum += std::polar(p.amplitude * overlap, phase);
  }
  return sum;
}

// Returns the delay (m) at which early and late correlations are equal, where the code loop locks.
double code_delay(const std::vector<SignalPath>& paths, const SignalShape& shape, double wavelength,
                  double ahead) {
  double delay = paths.front().delay;
  const double half = 0.5 * shape.spacing * shape.chip;
  for (int i = 0; i < 15; ++i) {
    const double early = std::abs(correlation(paths, shape, wavelength, delay - half, ahead));
    const double late = std::abs(correlation(paths, shape, wavelength, delay + half, ahead));
    if (early + late <= 0.0) break;
    delay += 0.5 * (2.0 - shape.spacing) * shape.chip * (late - early) / (late + early);
  }
  return delay;
}

}  // namespace

SignalTracker::SignalTracker(const SignalShape& shape, std::uint64_t seed, std::uint64_t stream)
    : shape_(shape),
      wavelength_(ppp::speed_of_light / shape.frequency),
      random_(mix(seed, 24), stream) {
  cycles_ = static_cast<std::int64_t>(random_.uniform(-1e6, 1e6));
}

// A slip happens when the loop changes to another path, or by chance when the signal is weak.
bool SignalTracker::slips(const SignalPath& strongest, double cn0, double interval) {
  const double hazard = 0.15 * std::exp(-(cn0 - 26.0) / 2.0) * interval;
  const bool weak = random_.chance(std::min(1.0, hazard));
  return strongest.surface != surface_ || weak;
}

std::optional<TrackedSignal> SignalTracker::track(const std::vector<SignalPath>& paths,
                                                  double elevation, double interval) {
  const double noise = random_.normal();
  if (paths.empty()) {
    tracked_ = locked_ = false;
    return {};
  }
  // The code loop averages fading; the phase loop follows it.
  constexpr int moments = 5;
  double code = 0.0;
  for (int i = 0; i < moments; ++i)
    code += code_delay(paths, shape_, wavelength_, -0.8 * i / moments) / moments;
  const Complex sum = correlation(paths, shape_, wavelength_, code, 0.0);
  const double gain = -9.0 * (1.0 - std::pow(std::sin(elevation), 0.6));
  TrackedSignal result;
  result.cn0 = shape_.cn0 + gain + 20.0 * std::log10(std::abs(sum) + 1e-6) + 0.6 * noise;
  if (result.cn0 < (tracked_ ? weakest_tracked : weakest_acquired)) {
    tracked_ = locked_ = false;
    return {};
  }
  const SignalPath& strongest = paths.front();
  const double power = std::pow(10.0, result.cn0 / 10.0);
  const double jitter = std::sqrt(0.5 * code_bandwidth * shape_.spacing / power);
  const double code_noise = std::hypot(shape_.chip * jitter, 0.05);
  result.code = code + code_noise * random_.normal();
  result.rate = strongest.rate + std::hypot(0.02, 2.0 / std::sqrt(power)) * random_.normal();
  // The phase lock follows one epoch after the code lock.
  const bool was_locked = locked_;
  locked_ = tracked_;
  tracked_ = true;
  const bool slipped = slips(strongest, result.cn0, interval);
  surface_ = strongest.surface;
  if (!locked_) return result;
  if (!was_locked || slipped) {
    const double size = 1.0 + std::floor(random_.uniform(0.0, was_locked ? 12.0 : 1e6));
    cycles_ += static_cast<std::int64_t>(random_.chance(0.5) ? size : -size);
    result.lost_lock = !was_locked || random_.chance(0.85);
  }
  const Complex turned =
      sum * std::polar(1.0, two_pi * strongest.delay / wavelength_ - strongest.phase);
  const double phase_noise =
      std::hypot(wavelength_ / two_pi * std::sqrt(phase_bandwidth / power), 5e-4);
  result.phase = strongest.delay - std::arg(turned) * wavelength_ / two_pi +
                 static_cast<double>(cycles_) * wavelength_ + phase_noise * random_.normal();
  return result;
}

Scatterers::Scatterers(std::uint64_t seed, std::uint64_t stream) : random_(mix(seed, 29), stream) {
  for (Scatterer& s : scatterers_) s = draw();
}

Scatterers::Scatterer Scatterers::draw() {
  Scatterer s;
  s.path.amplitude = random_.uniform(0.04, 0.16);
  s.path.delay = std::exp(random_.uniform(std::log(0.3), std::log(30.0)));
  s.path.phase = random_.uniform(0.0, 2.0 * std::numbers::pi);
  s.path.surface = 1;
  s.share = random_.uniform(-0.6, 0.6);
  return s;
}

void Scatterers::add_to(std::vector<SignalPath>& paths, double interval, double speed) {
  constexpr double lasting = 60.0, lasting_way = 40.0;  // s and m, mean life of a scatterer
  constexpr double drift = 4e-4;                        // m/s, because the satellite moves
  const double gone = interval * (1.0 / lasting + speed / lasting_way);
  for (Scatterer& s : scatterers_) {
    if (random_.chance(std::min(1.0, gone))) s = draw();
    s.path.rate = s.share * speed + drift;
    s.path.delay = std::clamp(s.path.delay + s.path.rate * interval, 0.1, 60.0);
    if (paths.empty()) continue;
    SignalPath path = s.path;  // relative to the strongest path
    path.amplitude *= paths.front().amplitude;
    path.delay += paths.front().delay;
    path.rate += paths.front().rate;
    paths.push_back(path);
  }
}

}  // namespace maploop::simulate
