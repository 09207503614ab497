// The kernel's buffers behind LCM: too small ones lose large messages without a word.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "msgs/realtime_setting.h"

namespace maploop::vehicle {

// The UDP sockets that this process has open, by their descriptors, ascending. LCM gives its own
// away to nobody: it is the one that was not there before LCM opened its URL.
std::vector<int> udp_sockets();

// Asks for a send buffer of `bytes` (with force where the process may) and reads back: "LCM: send
// buffer".
RealtimeSetting ask_for_send_buffer(int socket, int bytes);

// What listeners on this machine may ask for, as the text of /proc/sys/net/core/rmem_max has it;
// none: not readable. "LCM: receive buffers".
RealtimeSetting assess_receive_buffers(const std::optional<std::string>& rmem_max, int bytes);

}  // namespace maploop::vehicle
