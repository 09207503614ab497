#include "ppp/readers/files/file_kind.h"

#include "ppp/readers/files/lines.h"
#include "ppp/readers/streams/rtcm3.h"
#include "ppp/readers/streams/ubx.h"

namespace maploop::ppp {

FileKind file_kind(std::string_view text) {
  const auto first = text.substr(0, text.find('\n'));
  const auto start = trimmed(first);
  const auto label = columns(first, 60, 20);
  if (label.starts_with("CRINEX VERS")) return FileKind::observation;
  if (first.find("RINEX VERSION / TYPE") != std::string_view::npos) {
    const auto type = columns(first, 20, 1);
    if (type == "O") return FileKind::observation;
    if (type == "N" || type == "G" || type == "H") return FileKind::navigation;
    if (type == "C" || columns(first, 21, 1) == "C") return FileKind::clock;
    return FileKind::unknown;
  }
  if (label.starts_with("IONEX VERSION")) return FileKind::ionosphere_maps;
  if (label.starts_with("ANTEX VERSION / SYST")) return FileKind::antenna;
  if (first.size() > 30 && first[0] == '#' && first[1] >= 'a' && first[1] <= 'd') {
    return FileKind::orbit;
  }
  if (start.starts_with("%=BIA")) return FileKind::bias;
  if (start.starts_with("%=ORBEX")) return FileKind::attitude;
  if (start.starts_with("VERSION 2") || start.starts_with("version 2")) {
    return FileKind::earth_rotation;
  }
  if (start.starts_with("$$")) return FileKind::ocean_loading;
  const auto head = text.substr(0, 600);
  if (head.find("DIFFERENTIAL (P") != std::string_view::npos) return FileKind::dcb;
  if (is_ubx(text)) return FileKind::ubx;
  return is_rtcm3(text) ? FileKind::rtcm3 : FileKind::unknown;
}

FileKind kind_of_file(const std::filesystem::path& path) {
  return file_kind(read_head(path));
}

const char* name(FileKind kind) {
  switch (kind) {
    case FileKind::observation:
      return "observations";
    case FileKind::navigation:
      return "broadcast navigation";
    case FileKind::orbit:
      return "precise orbits";
    case FileKind::clock:
      return "precise clocks";
    case FileKind::antenna:
      return "antennas";
    case FileKind::bias:
      return "code biases";
    case FileKind::dcb:
      return "differential code biases";
    case FileKind::earth_rotation:
      return "earth rotation";
    case FileKind::ocean_loading:
      return "ocean loading";
    case FileKind::ionosphere_maps:
      return "maps of the ionosphere";
    case FileKind::attitude:
      return "attitudes of satellites";
    case FileKind::ubx:
      return "u-blox raw measurements";
    case FileKind::rtcm3:
      return "RTCM 3 observations";
    case FileKind::unknown:
      return "unknown";
  }
  return "unknown";
}

}  // namespace maploop::ppp
