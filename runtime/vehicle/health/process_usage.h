// Reports what this process has used of the machine so far.
#pragma once

#include <cstdint>

namespace maploop::vehicle {

double process_cpu_seconds();         // s, sum of all its threads
std::uint64_t process_peak_memory();  // bytes

}  // namespace maploop::vehicle
