// What is asked of an NTRIP caster (RTCM 10410.1, which has both versions).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "msgs/local_frame.h"
#include "msgs/time.h"

namespace maploop::sensors {

// ntrip://[USER[:PASSWORD]@]HOST[:PORT]/MOUNTPOINT[?version=1][&gga=LATITUDE,LONGITUDE,HEIGHT]
// ntrips:// is the same over TLS, by which nobody on the way reads the password. Degrees and
// metres; version 2 is understood by casters of version 1 too, but for a few.
struct NtripAddress {
  std::string user, password;
  std::string host;
  bool encrypted = false;
  std::uint16_t port = 2101;  // ntrips: 443
  std::string mountpoint;
  int version = 2;
  std::optional<Geodetic> position;  // said to the caster, again and again
  std::string text;                  // as it was given, without what is secret
};

bool is_ntrip(std::string_view text);

// Throws std::invalid_argument naming the text (without its password) and what is allowed.
NtripAddress parse_ntrip(std::string_view text);

// `time_of_day`: UTC.
std::string ntrip_request(const NtripAddress& address, Duration time_of_day);
// A GGA sentence with its end.
std::string ntrip_gga(const Geodetic& position, Duration time_of_day);

}  // namespace maploop::sensors
