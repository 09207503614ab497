#include "tests/support/real_data.h"

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace maploop::testing {
namespace {

std::filesystem::path existing_below(const char* variable, const char* below) {
  const char* root = std::getenv(variable);
  if (root == nullptr) return {};
  std::filesystem::path path = std::filesystem::path(root) / below;
  return std::filesystem::is_directory(path) ? path : std::filesystem::path();
}

}  // namespace

std::filesystem::path real_data() {
  return existing_below("MAPLOOP_DATA", "");
}

std::filesystem::path drive_0013() {
  return existing_below("MAPLOOP_CACHE", "2011_09_26/2011_09_26_drive_0013_sync");
}

std::filesystem::path source(const std::filesystem::path& file) {
  const char* root = std::getenv("MAPLOOP_SOURCE");
  return root != nullptr ? std::filesystem::path(root) / file : file;
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "maploop_test_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) {
    throw std::runtime_error("cannot make a temporary folder from " + name);
  }
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace maploop::testing
