// Reads the files of a run, which come in any order and are told apart by their content.
#pragma once

#include <filesystem>
#include <vector>

#include "ppp/readers/files/antex.h"
#include "ppp/readers/files/bias.h"
#include "ppp/readers/files/clock.h"
#include "ppp/readers/files/earth_rotation.h"
#include "ppp/readers/files/file_kind.h"
#include "ppp/readers/files/ionex.h"
#include "ppp/readers/files/navigation.h"
#include "ppp/readers/files/observation.h"
#include "ppp/readers/files/ocean_loading.h"
#include "ppp/readers/files/orbex.h"
#include "ppp/readers/files/sp3.h"
#include "ppp/readers/streams/rtcm3.h"
#include "ppp/readers/streams/ubx.h"

namespace maploop::ppp {

// Holds the content of the files by kind, one element for each file, in the order of reading.
struct GnssFiles {
  std::vector<Observations> observations;          // RINEX (also compact), UBX and RTCM 3
  std::vector<NavigationFile> navigation;          // RINEX, and messages within UBX and RTCM 3
  std::vector<OrbitFile> orbits;                   // SP3
  std::vector<ClockFile> clocks;                   // RINEX clocks
  std::vector<AntennaFile> antennas;               // ANTEX
  std::vector<BiasFile> biases;                    // Bias-SINEX and DCB
  std::vector<EarthRotationFile> earth_rotation;   // ERP
  std::vector<OceanLoadingFile> ocean_loading;     // BLQ
  std::vector<IonosphereMapFile> ionosphere_maps;  // IONEX
  std::vector<AttitudeFile> attitudes;             // ORBEX
};

// Calls `visit` with a pointer to each list of GnssFiles, in the order above.
template <class Visit>
void visit_lists(Visit visit) {
  visit(&GnssFiles::observations);
  visit(&GnssFiles::navigation);
  visit(&GnssFiles::orbits);
  visit(&GnssFiles::clocks);
  visit(&GnssFiles::antennas);
  visit(&GnssFiles::biases);
  visit(&GnssFiles::earth_rotation);
  visit(&GnssFiles::ocean_loading);
  visit(&GnssFiles::ionosphere_maps);
  visit(&GnssFiles::attitudes);
}

// Reads one file, adds it to the list of its kind and returns that kind. Throws ReadError if it
// cannot be read, is of no known kind, or is damaged.
FileKind read_into(const std::filesystem::path& path, GnssFiles& files);
// Does the same for a text that has been read already; `name` stands for it in errors.
FileKind parse_into(std::string_view text, const std::string& name, GnssFiles& files);

// Moves the content of other files to the end of each list.
void append(GnssFiles& files, GnssFiles others);

// Returns the regular files of a folder, sorted by name.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder);

// Reads products: one file, or the files of a folder sorted by name. In a folder, RINEX
// observations, files of unknown kind and the file `except` are skipped. Throws as read_into()
// does, and std::filesystem::filesystem_error.
void read_products(const std::filesystem::path& path, GnssFiles& files,
                   const std::filesystem::path& except = {});

}  // namespace maploop::ppp
