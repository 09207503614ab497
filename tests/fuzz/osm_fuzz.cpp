// OpenStreetMap's files as PBF, XML and OPL, by the first byte, and the networks made of them.
#include <unistd.h>

#include <array>
#include <climits>
#include <stdexcept>

#include "mapmatch/network_builder.h"
#include "mapmatch/osm_reader.h"
#include "mapmatch/road_network.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;

namespace {

// libosmium leaves a damaged PBF open, and a process cannot open any number of files.
void close_what_was_left_open(int first) {
  close_range(static_cast<unsigned>(first), UINT_MAX, 0);
}

int first_unused_descriptor() {
  const int descriptor = dup(STDIN_FILENO);
  close(descriptor);
  return descriptor;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::array<fuzz::NamedFile, 3> files{
      fuzz::NamedFile("map.osm.pbf"), fuzz::NamedFile("map.osm"), fuzz::NamedFile("map.osm.opl")};
  static const int unused = first_unused_descriptor();
  fuzz::Input input(data, size);
  const fuzz::NamedFile& file = files[input.byte() % files.size()];
  file.write(input.rest());
  try {
    const mapmatch::RoadNetwork network(mapmatch::build_network(mapmatch::read_osm(file.path())));
    for (std::uint32_t i = 0; i < network.size(); ++i) (void)network.at({i, true}, 1.0);
  } catch (const std::runtime_error&) {
  } catch (const std::invalid_argument&) {
  }
  close_what_was_left_open(unused);
  return 0;
}
