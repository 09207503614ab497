// This file reports how well this machine's clock follows UTC.
#pragma once

#include <sys/timex.h>

#include "msgs/time.h"
#include "runtime/core/realtime_setting.h"

namespace maploop::runtime {

// A program may discipline the kernel's clock by NTP, PTP or a receiver's pulse. This is what the
// kernel knows of it (adjtimex(2)).
struct UtcDiscipline {
  bool synchronized = false;  // a program disciplines the clock, and has said so lately
  bool pulse = false;         // a receiver's pulse (PPS) reaches the kernel
  Duration estimated_error{}, largest_error{};  // by that program
  double rate = 0.0;                            // ppm by which the kernel makes the clock faster
};

UtcDiscipline discipline_of(const timex& kernel);

// Returns "UTC": granted if the clock is disciplined.
RealtimeSetting assess(const UtcDiscipline& discipline);
// Does so for this machine.
RealtimeSetting assess_utc();

}  // namespace maploop::runtime
