// Doubts about a map (GeoJSON), and the small map that they correct.
#include "tests/fuzz/fuzz_input.h"
#include "tools/match/doubts_file.h"
#include "tools/match/map_corrections.h"

using namespace maploop;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(data, size);
  try {
    const std::vector<MapDoubt> doubts = match::read_doubts(file.path(), 0.0);
    mapmatch::MapExtract map;
    for (int i = 1; i <= 4; ++i) map.nodes.push_back({i, 48.7, 8.42 + 1e-3 * i});
    map.ways.resize(2);
    map.ways[0].road.way_id = 10;
    map.ways[0].nodes = {1, 2, 3};
    map.ways[1].road.way_id = 11;
    map.ways[1].nodes = {3, 4};
    const match::Corrections done = match::correct(map, doubts);
    fuzz::require(done.roads + done.directions + done.turns + done.left == doubts.size());
    (void)mapmatch::build_network(map);
  } catch (const std::runtime_error&) {
  }
  return 0;
}
