// Tiles of heights, plain or in an archive, and grids of the geoid: what the first byte says.
#include <cmath>

#include "msgs/input_file.h"
#include "ppp/heights/geoid_grid.h"
#include "ppp/heights/height_tile.h"
#include "ppp/heights/zip_archive.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;
using namespace maploop::ppp;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const bool grid = input.byte() == 'g';
  const std::string_view bytes = input.text();
  try {
    if (grid) {
      const GeoidGrid geoid(bytes);
      for (const double angle : {-180.0, -90.0, 0.0, 49.9, 90.0, 359.9}) {
        const auto height = geoid.at(angle, angle);
        fuzz::require(!height || std::abs(*height) <= 200.0);
      }
      return 0;
    }
    fuzz::require(unpacked(bytes, ".hgt", 1000).size() <= 1000);
  } catch (const std::runtime_error&) {
    return 0;
  }
  const fuzz::NamedFile file("N49E011.hgt");
  file.write({data + 1, size - 1});
  try {
    const HeightTile tile = read_height_tile(file.path());
    (void)tile.at(49.5, 11.5);
  } catch (const FileError&) {
  }
  return 0;
}
