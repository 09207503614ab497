#include "ppp/products/ssr_electrons.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace maploop::ppp {
namespace {

using std::numbers::pi;

constexpr double unknown_sigma = 5.0;  // TECU

// Returns the factor that makes the harmonics of a degree n and an order m orthonormal on the
// sphere, apart from 4 pi.
double normalization(int n, int m) {
  double ratio = 1.0;  // (n - m)! / (n + m)!
  for (int k = n - m + 1; k <= n + m; ++k) ratio /= k;
  return std::sqrt((m == 0 ? 1.0 : 2.0) * (2 * n + 1) * ratio);
}

// Calls `visit(n, m, cosine, sine)` with the places of a harmonic's coefficients; an order of 0 has
// no sine.
template <class Visit>
void visit_harmonics(const SsrLayer& layer, Visit visit) {
  std::size_t cosine = 0, sine = 0;
  for (int m = 0; m <= layer.order; ++m) {
    for (int n = m; n <= layer.degree; ++n) visit(n, m, cosine++, m > 0 ? sine++ : 0);
  }
}

// Returns the content of a layer above a latitude, at an angle from the meridian of the sun's
// greatest effect (rad), TECU.
double content(const SsrLayer& layer, double latitude, double angle) {
  double sum = 0.0;
  visit_harmonics(layer, [&](int n, int m, std::size_t cosine, std::size_t sine) {
    double wave = layer.cosines[cosine] * std::cos(m * angle);
    if (m > 0) wave += layer.sines[sine] * std::sin(m * angle);
    sum += wave * std::assoc_legendre(static_cast<unsigned>(n), static_cast<unsigned>(m),
                                      std::sin(latitude));
  });
  return sum;
}

}  // namespace

// The messages' harmonics are orthonormal: the factors are the same for every place.
void SsrElectrons::set(SsrIonosphere message) {
  for (SsrLayer& layer : message.layers) {
    visit_harmonics(layer, [&](int n, int m, std::size_t cosine, std::size_t sine) {
      layer.cosines[cosine] *= normalization(n, m);
      if (m > 0) layer.sines[sine] *= normalization(n, m);
    });
  }
  message_ = std::move(message);
}

bool SsrElectrons::covers(GpsTime t) const {
  return message_ && std::chrono::abs(t - message_->time) <= message_->interval / 2 + longest_age;
}

std::optional<VerticalElectrons> SsrElectrons::at(const PiercePoint& place, GpsTime t) const {
  if (!covers(t)) return {};
  // The greatest effect is at 14:00 of local time (IGS SSR 1.00, section on the ionosphere).
  constexpr double greatest = 50400.0, half_day = 43200.0;  // s
  const double of_day = std::fmod(seconds_of_week(t), 2.0 * half_day);
  const double angle = place.longitude + (of_day - greatest) * pi / half_day;
  double sum = 0.0;
  for (const SsrLayer& layer : message_->layers) sum += content(layer, place.latitude, angle);
  const double sigma = message_->sigma > 0.0 ? message_->sigma : unknown_sigma;
  return VerticalElectrons{std::max(sum, 0.0), sigma,
                           static_cast<std::uint64_t>(message_->time.time_since_epoch().count())};
}

}  // namespace maploop::ppp
