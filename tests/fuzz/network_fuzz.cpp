// Road networks, with the checksum that the content has.
#include <stdexcept>

#include "mapmatch/network_file.h"
#include "mapmatch/road_network.h"
#include "msgs/archive.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Bytes sealed = seal({data, size});
  const fuzz::MemoryFile file(sealed.data(), sealed.size());
  try {
    const mapmatch::RoadNetwork network(mapmatch::load_network(file.path()));
    for (std::uint32_t i = 0; i < network.size(); ++i) (void)network.at({i, true}, 1.0);
  } catch (const std::exception&) {
  }
  return 0;
}
