// Evaluates the ionosphere's electrons that a stream of corrections contains.
#pragma once

#include <optional>

#include "ppp/products/ionosphere.h"
#include "ppp/readers/corrections/ssr.h"

namespace maploop::ppp {

class SsrElectrons : public ElectronContent {
 public:
  // This is how long a message stays in use after its interval.
  static constexpr Duration longest_age = std::chrono::minutes(10);

  // Replaces what was known.
  void set(SsrIonosphere message);
  bool covers(GpsTime t) const override;
  // Returns nothing without a message, or with one that is too old.
  std::optional<VerticalElectrons> at(const PiercePoint& place, GpsTime t) const override;

 private:
  std::optional<SsrIonosphere> message_;  // its coefficients are those of harmonics as they are
};

}  // namespace maploop::ppp
