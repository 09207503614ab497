#include "runtime/core/utc_discipline.h"

#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <string>
#include <system_error>

namespace maploop::runtime {
namespace {

constexpr const char* discipline_remedy = "apt install chrony, or linuxptp if the network has PTP";

RealtimeRequest utc() {
  return {"UTC", "a disciplined clock"};
}

}  // namespace

UtcDiscipline discipline_of(const timex& kernel) {
  constexpr double counts_per_ppm = 65536.0;
  UtcDiscipline d;
  d.synchronized = (kernel.status & STA_UNSYNC) == 0;
  d.pulse = (kernel.status & STA_PPSSIGNAL) != 0;
  d.estimated_error = std::chrono::microseconds(kernel.esterror);
  d.largest_error = std::chrono::microseconds(kernel.maxerror);
  d.rate = static_cast<double>(kernel.freq) / counts_per_ppm;
  return d;
}

RealtimeSetting assess(const UtcDiscipline& discipline) {
  const std::string steered = fmt::format("steered by {:+.2f} ppm{}", discipline.rate,
                                          discipline.pulse ? ", with a receiver's pulse" : "");
  if (discipline.synchronized) {
    return utc().granted(fmt::format("disciplined to {:.3f} ms, at most {:.3f} ms, {}",
                                     1e3 * to_seconds(discipline.estimated_error),
                                     1e3 * to_seconds(discipline.largest_error), steered));
  }
  return utc().limiting(
      "not disciplined, " + steered,
      "a run's stamps leave UTC by up to seconds a day; no estimate depends on it",
      discipline_remedy);
}

RealtimeSetting assess_utc() {
  timex kernel{};  // modes 0: nothing is set
  if (adjtimex(&kernel) >= 0) return assess(discipline_of(kernel));
  return utc().unknown(std::system_category().message(errno), discipline_remedy);
}

}  // namespace maploop::runtime
