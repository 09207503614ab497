// Tiled maps: a tile, or the table of tiles, with the checksums that they have.
#include <algorithm>
#include <stdexcept>

#include "mapmatch/network_builder.h"
#include "mapmatch/road_network.h"
#include "mapmatch/tiled_map.h"
#include "msgs/archive.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const bool is_table = input.byte() % 2 == 1;
  const Bytes content = seal(input.rest());
  Bytes file = mapmatch::sealed(mapmatch::TiledMapHead{});
  const std::size_t after_head = file.size();
  file.insert(file.end(), content.begin(), content.end());
  Bytes table = content;
  if (!is_table) {
    mapmatch::TileTable one;
    one.tiles.push_back({mapmatch::tile_at(49.01, 8.41), after_head, content.size()});
    table = mapmatch::sealed(one);
    file.insert(file.end(), table.begin(), table.end());
  }
  const Bytes head =
      mapmatch::sealed(mapmatch::TiledMapHead{file.size() - table.size(), table.size()});
  std::copy(head.begin(), head.end(), file.begin());
  const fuzz::MemoryFile written(file.data(), file.size());
  try {
    const mapmatch::TiledMap map(written.path());
    (void)map.area();
    const mapmatch::RoadNetwork network(mapmatch::build_network(map.read()));
    for (std::uint32_t i = 0; i < network.size(); ++i) (void)network.at({i, true}, 1.0);
  } catch (const std::exception&) {
  }
  return 0;
}
