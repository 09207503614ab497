// What the spy shows, as text.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/lcm/schema.h"
#include "tools/spy/traffic.h"

namespace maploop::spy {

// Without what a terminal would obey: bytes that cannot be printed are '?'.
std::string printable(std::string_view text);

// One line, columns apart by spaces: CHANNEL TYPE COUNT RATE_HZ JITTER_MS AGE_S SILENT_S BYTES LOST
// BAD. "-" where there is nothing to say.
std::string table_header();
std::string table_row(const ChannelStatus& status);

// One line, one JSON object; null where there is nothing to say.
std::string json_row(const ChannelStatus& status);

// One "path = value" a line; of an array of numbers its sizes and the first few values.
std::vector<std::string> field_lines(const schema::Schema& schema,
                                     std::span<const std::uint8_t> message);

// The runs, rings, deadlines and degraded modes in a line each, from the last HEALTH and DEADLINES;
// nothing where these have not come or are not ours.
std::vector<std::string> vehicle_lines(const schema::Schema& schema, const Traffic& traffic);

}  // namespace maploop::spy
