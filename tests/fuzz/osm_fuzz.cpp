// OpenStreetMap's files as PBF, XML and OPL, by the first byte, and the networks made of them.
#include <array>
#include <stdexcept>

#include "mapmatch/network_builder.h"
#include "mapmatch/osm_reader.h"
#include "mapmatch/road_network.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::array<fuzz::NamedFile, 3> files{
      fuzz::NamedFile("map.osm.pbf"), fuzz::NamedFile("map.osm"), fuzz::NamedFile("map.osm.opl")};
  fuzz::Input input(data, size);
  const fuzz::NamedFile& file = files[input.byte() % files.size()];
  file.write(input.rest());
  try {
    const mapmatch::RoadNetwork network(mapmatch::build_network(mapmatch::read_osm(file.path())));
    for (std::uint32_t i = 0; i < network.size(); ++i) (void)network.at({i, true}, 1.0);
  } catch (const std::runtime_error&) {
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
