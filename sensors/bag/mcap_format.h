// This file names the parts of MCAP files (https://mcap.dev/spec) for their reader and their
// writer.
#pragma once

#include <cstdint>
#include <string_view>

namespace maploop::sensors::bag {

constexpr std::string_view mcap_magic = "\x89MCAP0\r\n";

// These tell the kinds of records apart.
namespace mcap_op {
constexpr std::uint8_t header = 0x01, footer = 0x02, schema = 0x03, channel = 0x04, message = 0x05,
                       chunk = 0x06, message_index = 0x07, chunk_index = 0x08, statistics = 0x0b,
                       data_end = 0x0f;
}  // namespace mcap_op

// The profile that the header of our own recordings names (sensors/replay/log_events.h).
constexpr std::string_view mcap_profile = "maploop";

}  // namespace maploop::sensors::bag
