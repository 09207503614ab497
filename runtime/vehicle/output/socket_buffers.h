// Asks for the kernel's buffers behind LCM: too small ones lose large messages silently.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "msgs/realtime_setting.h"

namespace maploop::vehicle {

// Returns the descriptors of the UDP sockets that this process has open, ascending. LCM does not
// give access to its socket: it is the one that was not open before LCM opened its URL.
std::vector<int> udp_sockets();

// Asks for a send buffer of `bytes`, beyond the system's limit if the process may (SO_SNDBUFFORCE),
// and reads back what was granted. The result is named "LCM: send buffer".
RealtimeSetting ask_for_send_buffer(int socket, int bytes);

// Returns what listeners on this machine may ask for, named "LCM: receive buffers". `rmem_max` is
// the text of /proc/sys/net/core/rmem_max, or nullopt if it is not readable.
RealtimeSetting assess_receive_buffers(const std::optional<std::string>& rmem_max, int bytes);

}  // namespace maploop::vehicle
