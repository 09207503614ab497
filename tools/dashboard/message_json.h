// LCM messages as JSON, for browsers.
#pragma once

#include <string>

#include "msgs/lcm/decoded_message.h"

namespace maploop::dashboard {

// Fields by their names as in the .lcm file, arrays as lists. Of what a page does not show
// histograms are left out, which are most of DEADLINES; an array of bytes is a string in base64.
// Numbers that are not finite are null; text that is no UTF-8 has its bytes replaced.
std::string to_json(const schema::DecodedMessage& message);

}  // namespace maploop::dashboard
