// Stands in place of readers that bring libraries which a vehicle does not need. A file of theirs
// is refused with the remedy. (The linker takes these functions before it looks into the readers'
// libraries.)
#include <stdexcept>

#include "mapmatch/osm_reader.h"
#include "msgs/input_file.h"
#include "sensors/bag/sqlite_reader.h"
#include "sensors/velodyne/capture_reader.h"
#include "tools/match/track_file.h"

namespace maploop {

mapmatch::MapExtract mapmatch::read_osm(const std::filesystem::path& file, const OsmOptions&) {
  throw std::runtime_error(
      "'" + file.string() +
      "' is neither a network file nor a tiled map, which are the kinds of map "
      "that a vehicle reads; 'maploop map build' makes them");
}

match::Track match::parse_gpx_track(std::string_view, std::string_view name, const TrackOptions&) {
  throw std::runtime_error(std::string(name) + ": maploop-vehicle does not read GPX; maploop does");
}

namespace sensors {

std::unique_ptr<bag::RecordingReader> bag::open_sqlite(const Opening& opening) {
  throw FileError(opening.file, "maploop-vehicle does not read databases of rosbag2; maploop does");
}

struct CaptureReader::File {};

CaptureReader::CaptureReader(const std::filesystem::path& path) {
  throw FileError(path, "maploop-vehicle does not read captures; maploop does");
}

CaptureReader::~CaptureReader() = default;

bool CaptureReader::next(CapturedPacket&) {
  return false;
}

}  // namespace sensors
}  // namespace maploop
