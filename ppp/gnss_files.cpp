#include "ppp/gnss_files.h"

#include <algorithm>
#include <iterator>

namespace maploop::ppp {

namespace {

// Returns whether a text is ZIP or the output of Unix's compress.
bool is_archive(std::string_view text) {
  return text.starts_with("PK\3\4") || text.starts_with("\x1f\x9d");
}

}  // namespace

FileKind parse_into(std::string_view text, const std::string& name, GnssFiles& files) {
  const FileKind kind = file_kind(text);
  NavigationFile sent;  // ephemerides recorded with a receiver's observations
  sent.file = name;
  switch (kind) {
    case FileKind::observation:
      files.observations.push_back(parse_observations(text, name));
      break;
    case FileKind::rtcm3:
      files.observations.push_back(parse_rtcm3(text, name, &sent));
      break;
    case FileKind::ubx:
      files.observations.push_back(parse_ubx(text, name, &sent));
      break;
    case FileKind::navigation:
      files.navigation.push_back(parse_navigation(text, name));
      break;
    case FileKind::orbit:
      files.orbits.push_back(parse_sp3(text, name));
      break;
    case FileKind::clock:
      files.clocks.push_back(parse_clock(text, name));
      break;
    case FileKind::antenna:
      files.antennas.push_back(parse_antex(text, name));
      break;
    case FileKind::bias:
      files.biases.push_back(parse_bias_sinex(text, name));
      break;
    case FileKind::dcb:
      files.biases.push_back(parse_dcb(text, name));
      break;
    case FileKind::earth_rotation:
      files.earth_rotation.push_back(parse_erp(text, name));
      break;
    case FileKind::ocean_loading:
      files.ocean_loading.push_back(parse_blq(text, name));
      break;
    case FileKind::ionosphere_maps:
      files.ionosphere_maps.push_back(parse_ionex(text, name));
      break;
    case FileKind::attitude:
      files.attitudes.push_back(parse_orbex(text, name));
      break;
    case FileKind::unknown:
      if (is_archive(text)) {
        throw ReadError(name + ": is compressed as .zip or .Z, which is not read: unpack it");
      }
      throw ReadError(
          name + (text.empty() ? ": is empty" : "") +
          ": not in a known format; supported are RINEX observations, navigation and clocks, "
          "compact RINEX, SP3, ANTEX, Bias-SINEX, DCB, ERP, BLQ, IONEX, ORBEX, UBX, RTCM 3");
  }
  if (!sent.kepler.empty() || !sent.glonass.empty() || !sent.ionosphere.empty() || sent.refused > 0)
    files.navigation.push_back(std::move(sent));
  return kind;
}

void append(GnssFiles& files, GnssFiles others) {
  visit_lists([&](auto list) { std::ranges::move(others.*list, std::back_inserter(files.*list)); });
}

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

FileKind read_into(const std::filesystem::path& path, GnssFiles& files) {
  return parse_into(read_file(path), path.string(), files);
}

void read_products(const std::filesystem::path& path, GnssFiles& files,
                   const std::filesystem::path& except) {
  if (!std::filesystem::is_directory(path)) {
    read_into(path, files);
    return;
  }
  for (const std::filesystem::path& file : files_in(path)) {
    if (file == except) continue;
    const FileKind kind = kind_of_file(file);
    if (kind != FileKind::unknown && kind != FileKind::observation) read_into(file, files);
  }
}

}  // namespace maploop::ppp
