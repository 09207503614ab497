#include "tools/lcm_log/log_types.h"

#include <fstream>
#include <iterator>
#include <stdexcept>

namespace maploop::lcm_log {
namespace {

constexpr std::uintmax_t kMaximumBytes = 1 << 20;  // no one writes more types into one file by hand

std::string read(const std::filesystem::path& file) {
  const auto refuse = [&](const char* why) {
    throw std::runtime_error("cannot read the types of '" + file.string() + "': " + why);
  };
  if (!std::filesystem::is_regular_file(file)) refuse("there is no such file");
  if (std::filesystem::file_size(file) > kMaximumBytes) refuse("it is larger than 1 MB");
  std::ifstream in(file, std::ios::binary);
  if (!in) refuse("it may not be opened");
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (in.bad()) refuse("reading failed half-way");
  return text;
}

}  // namespace

schema::Schema load_types(std::span<const std::filesystem::path> files) {
  const auto own = schema::own_types();
  std::vector<schema::TypeText> texts(own.begin(), own.end());
  for (const auto& file : files) texts.push_back({file.string(), read(file)});
  return schema::Schema(texts);
}

}  // namespace maploop::lcm_log
