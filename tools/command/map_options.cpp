#include "tools/command/map_options.h"

#include <stdexcept>
#include <string>

#include "msgs/named_enum.h"

namespace maploop::tools {

void set_map(vehicle::MapParameters& map, const std::filesystem::path& file,
             std::optional<vehicle::MapMode> mode) {
  if (!file.empty()) map.file = file.string();
  if (!mode) return;
  map.mode = *mode;
  if (map.mode != vehicle::MapMode::none && map.file.empty()) {
    throw std::runtime_error("--map-mode " + std::string(name_of(map.mode)) +
                             " needs a map: --map FILE");
  }
}

}  // namespace maploop::tools
