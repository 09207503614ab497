// Archives: as they are, and as the content of a sound one with values of every kind.
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "msgs/archive.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    (void)unseal({data, size});
  } catch (const ArchiveError&) {
  }
  try {
    ArchiveReader reader({data, size});
    reader.section("fuzz", 1);
    std::vector<std::string> names;
    std::vector<std::vector<double>> rows;
    std::vector<std::optional<std::array<int, 3>>> some;
    std::variant<bool, std::string, Eigen::Matrix3d> either;
    reader(names, rows, some, either);
    reader.finish();
    ArchiveWriter writer;
    writer.section("fuzz", 1);
    writer(names, rows, some, either);
    fuzz::require(writer.content().size() == size);
  } catch (const ArchiveError&) {
  }
  return 0;
}
