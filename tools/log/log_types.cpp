#include "tools/log/log_types.h"

#include "msgs/input_file.h"
#include "msgs/input_limits.h"

namespace maploop::lcm_log {
schema::Schema load_types(std::span<const std::filesystem::path> files) {
  const auto own = schema::own_types();
  std::vector<schema::TypeText> texts(own.begin(), own.end());
  for (const auto& file : files) {
    texts.push_back({file.string(), read_text(file, input_limits::settings)});
  }
  return schema::Schema(texts);
}

}  // namespace maploop::lcm_log
