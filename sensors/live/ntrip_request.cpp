#include "sensors/live/ntrip_request.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "msgs/base64.h"
#include "msgs/frames.h"
#include "sensors/gnss/nmea.h"
#include "sensors/live/endpoint.h"
#include "sensors/number.h"

namespace maploop::sensors {
namespace {

constexpr std::string_view ntrip_scheme = "ntrip://", ntrips_scheme = "ntrips://";

[[noreturn]] void refuse_address(const std::string& shown, const std::string& why) {
  throw std::invalid_argument("'" + shown + "': " + why +
                              "; expected ntrip:// (or ntrips:// for TLS) and "
                              "[USER[:PASSWORD]@]HOST[:PORT]/MOUNTPOINT, optionally followed by "
                              "?version=1 and ?gga=LATITUDE,LONGITUDE,HEIGHT with & between");
}

// Takes the part before `end` off the text, with `end`; takes all of it if there is no `end`.
std::string_view take_until(std::string_view& text, char end) {
  const std::size_t at = text.find(end);
  const std::string_view part = text.substr(0, at);
  text.remove_prefix(at == std::string_view::npos ? text.size() : at + 1);
  return part;
}

std::optional<Geodetic> read_position(std::string_view text) {
  const auto latitude = parse_number<double>(take_until(text, ','));
  const auto longitude = parse_number<double>(take_until(text, ','));
  const auto height = parse_number<double>(text);
  if (!latitude || !longitude || !height || std::abs(*latitude) > 90.0 ||
      std::abs(*longitude) > 180.0 || std::abs(*height) >= 1e5) {
    return {};
  }
  return Geodetic{radians(*latitude), radians(*longitude), *height};
}

bool printable(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
}

}  // namespace

bool is_ntrip(std::string_view text) {
  return text.starts_with(ntrip_scheme) || text.starts_with(ntrips_scheme);
}

NtripAddress parse_ntrip(std::string_view text) {
  NtripAddress a;
  a.encrypted = text.starts_with(ntrips_scheme);
  if (a.encrypted) a.port = 443;
  const std::size_t scheme = (a.encrypted ? ntrips_scheme : ntrip_scheme).size();
  std::string_view rest = text.substr(std::min(text.size(), scheme));
  // A password may contain any character but a line end; the host follows the last @.
  const std::size_t at = rest.rfind('@');
  std::string_view who = at == std::string_view::npos ? std::string_view{} : rest.substr(0, at);
  if (at != std::string_view::npos) rest.remove_prefix(at + 1);
  a.user = take_until(who, ':');
  a.password = who;
  a.text = without_secrets(text);
  if (!is_ntrip(text)) refuse_address(a.text, "is not an NTRIP address");
  if (!printable(text))
    refuse_address(a.text, "contains characters that are not allowed in an address");
  const bool has_mountpoint = rest.find('/') != std::string_view::npos;
  std::string_view host = take_until(rest, '/');
  a.host = take_until(host, ':');
  if (!host.empty()) a.port = parse_number<std::uint16_t>(host).value_or(0);
  if (a.port == 0) refuse_address(a.text, "has no port between 1 and 65535");
  a.mountpoint = take_until(rest, '?');
  if (a.host.empty()) refuse_address(a.text, "has no host");
  if (!has_mountpoint || a.mountpoint.empty()) refuse_address(a.text, "has no mountpoint");
  while (!rest.empty()) {
    std::string_view value = take_until(rest, '&');
    const std::string_view key = take_until(value, '=');
    if (key == "version" && (value == "1" || value == "2")) {
      a.version = value == "1" ? 1 : 2;
      continue;
    }
    if (key == "gga") a.position = read_position(value);
    if (key != "gga" || !a.position) {
      refuse_address(
          a.text, "has the unknown option '" + std::string(key) + "=" + std::string(value) + "'");
    }
  }
  return a;
}

std::string ntrip_gga(const Geodetic& p, Duration time_of_day) {
  const auto seconds = static_cast<long>(time_of_day / std::chrono::seconds(1));
  std::array<char, 16> time{}, height{};
  std::snprintf(time.data(), time.size(), "%02ld%02ld%02ld.00", seconds / 3600 % 24,
                seconds / 60 % 60, seconds % 60);
  std::snprintf(height.data(), height.size(), "%.3f", p.height);
  return nmea_sentence(
      std::string("GPGGA,") + time.data() + ',' + nmea_angle_fields(p.latitude, 2, "NS") + ',' +
      nmea_angle_fields(p.longitude, 3, "EW") + ",1,10,1.0," + height.data() + ",M,0.0,M,,");
}

std::string ntrip_request(const NtripAddress& a, Duration time_of_day) {
  const bool second = a.version == 2;
  std::string text = "GET /" + a.mountpoint + (second ? " HTTP/1.1\r\n" : " HTTP/1.0\r\n");
  if (second) {
    text += "Host: " + a.host + ":" + std::to_string(a.port) + "\r\nNtrip-Version: Ntrip/2.0\r\n";
    if (a.position) text += "Ntrip-GGA: " + ntrip_gga(*a.position, time_of_day);
  }
  text += "User-Agent: NTRIP maploop\r\nAccept: */*\r\n";
  if (!a.user.empty()) {
    text += "Authorization: Basic " + base64(a.user + ":" + a.password) + "\r\n";
  }
  return text + "Connection: close\r\n\r\n";
}

}  // namespace maploop::sensors
