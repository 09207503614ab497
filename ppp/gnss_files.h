// The files of a run, in any order, told apart by content.
#pragma once

#include <filesystem>
#include <vector>

#include "ppp/readers/antex.h"
#include "ppp/readers/bias.h"
#include "ppp/readers/clock.h"
#include "ppp/readers/earth_rotation.h"
#include "ppp/readers/file_kind.h"
#include "ppp/readers/navigation.h"
#include "ppp/readers/observation.h"
#include "ppp/readers/ocean_loading.h"
#include "ppp/readers/rtcm3.h"
#include "ppp/readers/sp3.h"
#include "ppp/readers/ubx.h"

namespace maploop::ppp {

struct GnssFiles {
  std::vector<Observations> observations;
  std::vector<NavigationFile> navigation;
  std::vector<OrbitFile> orbits;
  std::vector<ClockFile> clocks;
  std::vector<AntennaFile> antennas;
  std::vector<BiasFile> biases;
  std::vector<EarthRotationFile> earth_rotation;
  std::vector<OceanLoadingFile> ocean_loading;
};

// Reads one file into its place; returns what it was. Throws ReadError: it cannot be read, is none
// of these, or is damaged.
FileKind read_into(const std::filesystem::path& path, GnssFiles& files);
// The same for a text that was read already.
FileKind parse_into(std::string_view text, const std::string& name, GnssFiles& files);

// Regular files, in the order of their names.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder);

// Products: a file, or a folder's files in the order of their names. In a folder, what is none of
// these is passed over, and so are observations. Throws as read_into(), and
// std::filesystem::filesystem_error.
void read_products(const std::filesystem::path& path, GnssFiles& files);

}  // namespace maploop::ppp
