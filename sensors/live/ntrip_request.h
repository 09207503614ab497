// This file makes the request to an NTRIP caster (RTCM 10410.1, which contains both versions).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "msgs/local_frame.h"
#include "msgs/time.h"

namespace maploop::sensors {

// The text form, in degrees and metres, is
//   ntrip://[USER[:PASSWORD]@]HOST[:PORT]/MOUNTPOINT[?version=1][&gga=LATITUDE,LONGITUDE,HEIGHT]
// ntrips:// is the same over TLS, which encrypts the password. All but a few casters of version 1
// understand version 2 too.
struct NtripAddress {
  std::string user, password;
  std::string host;
  bool encrypted = false;
  std::uint16_t port = 2101;  // ntrips: 443
  std::string mountpoint;
  int version = 2;
  std::optional<Geodetic> position;  // sent to the caster periodically
  std::string text;                  // as it was given, without secrets
};

bool is_ntrip(std::string_view text);

// Throws std::invalid_argument that names the text (without its password) and states what is
// allowed.
NtripAddress parse_ntrip(std::string_view text);

// `time_of_day` is UTC since midnight.
std::string ntrip_request(const NtripAddress& address, Duration time_of_day);
// Returns a GGA sentence with its line end.
std::string ntrip_gga(const Geodetic& position, Duration time_of_day);

}  // namespace maploop::sensors
