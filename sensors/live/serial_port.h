// This file opens serial lines.
#pragma once

#include <string>

namespace maploop::sensors {

bool is_baud_rate(int baud);

// Opens a serial device for raw bytes: 8 data bits, no parity, no flow control, without waiting for
// a carrier; reads do not block. Returns its descriptor, or -1 with the reason in `problem`.
int open_serial(const std::string& device, int baud, std::string& problem);

}  // namespace maploop::sensors
