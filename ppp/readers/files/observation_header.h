// Reads the header of a RINEX observation file, 2.00 to 2.12 and 3.00 to 3.05.
#pragma once

#include "ppp/observations.h"
#include "ppp/readers/files/lines.h"

namespace maploop::ppp {

struct HeaderInForce {
  ObservationHeader header;
  Duration to_gps{0};  // added to the file's stamps to get GPS time

  bool version3() const { return header.version >= 3.0; }
};

// Reads from the current line, RINEX VERSION / TYPE, up to END OF HEADER.
HeaderInForce read_observation_header(Lines& lines);
// Returns what a line of a header says it contains.
std::string_view header_label(std::string_view line);

// Applies the header record of the current line, also one of an event inside the file: types of
// observation, scale factors, marker, receiver, antenna, approximate position, interval or GLONASS
// channels. Other records are skipped.
void apply_header_record(Lines& lines, HeaderInForce& in_force);

// Takes over what the records of an event inside the file have changed. An antenna that is moved on
// its marker is not followed, which is counted as a refusal.
void take_event(HeaderInForce& in_force, const Lines& lines, Observations& result);

}  // namespace maploop::ppp
