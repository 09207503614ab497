// What systemd wants to hear of a service (sd_notify(3)).
#pragma once

#include <string_view>

namespace maploop::tools {

// "READY=1", "WATCHDOG=1", "STOPPING=1". Where no service manager asked for it (NOTIFY_SOCKET),
// does nothing.
void tell_service_manager(std::string_view state);

}  // namespace maploop::tools
