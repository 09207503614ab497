// Formats the output of the spy as text.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/lcm/schema.h"
#include "tools/spy/traffic.h"

namespace maploop::spy {

// Replaces control characters by '?', so that the terminal does not execute them.
std::string printable(std::string_view text);

// Return one line with columns separated by spaces: CHANNEL TYPE COUNT RATE_HZ JITTER_MS AGE_S
// SILENT_S BYTES LOST BAD. "-" stands for an unknown value.
std::string table_header();
std::string table_row(const ChannelStatus& status);

// Returns one JSON object on one line; null stands for an unknown value.
std::string json_row(const ChannelStatus& status);

// Returns lines "path = value"; for an array of numbers its sizes and the first few values.
std::vector<std::string> field_lines(const schema::Schema& schema,
                                     std::span<const std::uint8_t> message);

// Returns lines about the runs, rings, deadlines and degraded modes, from the last HEALTH,
// DEADLINES and PPP_STATE; nothing for messages that have not arrived or are not maploop's.
std::vector<std::string> vehicle_lines(const Traffic& traffic);

}  // namespace maploop::spy
