// Converts LCM messages to JSON, for browsers and for MCAP files.
#pragma once

#include <string>

#include "msgs/lcm/decoded_message.h"

namespace maploop::lcm_log {

// Fields have the names of the .lcm file, arrays are lists. Histograms, which are the largest part
// of DEADLINES and which no page shows, are left out; an array of bytes is a string in base64.
// Numbers that are not finite are null; invalid UTF-8 in texts is replaced.
std::string to_json(const schema::Field& message);

// Returns the JSON schema of what to_json() makes of the messages of a type.
std::string json_schema(const schema::Type& type);

}  // namespace maploop::lcm_log
