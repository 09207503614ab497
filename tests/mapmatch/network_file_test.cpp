#include "mapmatch/network_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "msgs/archive.h"
#include "tests/mapmatch/small_map.h"
#include "tests/support/real_data.h"

namespace maploop::mapmatch {
namespace {

using maploop::testing::real_data;
using maploop::testing::TemporaryFolder;

Bytes bytes_of(const NetworkData& data) {
  ArchiveWriter writer;
  writer(data);
  return writer.take();
}

std::string refusal_to_load(const std::filesystem::path& file) {
  try {
    load_network(file);
    return "";
  } catch (const std::runtime_error& e) {
    return e.what();
  }
}

TEST(NetworkFile, ContainsTheWholeNetwork) {
  MAPLOOP_REQUIRE_REAL_DATA();
  TemporaryFolder folder;
  const auto file = folder.path() / "karlsruhe.network";
  const NetworkData built = open_network(real_data() / "maps" / "karlsruhe_2012-04.osm.pbf");
  save_network(file, built);
  EXPECT_EQ(bytes_of(open_network(file)), bytes_of(built));
}

TEST(NetworkFile, DamagedCutForeignAndMissingFilesAreRefused) {
  TemporaryFolder folder;
  const auto file = folder.path() / "a.network";
  save_network(file, build_network(
                         testing::SmallMap().node(1, 0, 0).node(2, 9, 0).way(1, {1, 2}).extract()));
  std::ifstream in(file, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(in), {}};
  const auto with = [&](const std::string& content) {
    std::ofstream(file, std::ios::binary) << content;
    return refusal_to_load(file);
  };
  EXPECT_EQ(with(whole), "");
  EXPECT_THAT(with(whole.substr(0, whole.size() - 1)), ::testing::HasSubstr("a.network"));
  for (std::size_t at = 0; at < whole.size(); at += 3) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ 1);
    EXPECT_NE(with(flipped), "") << at;
  }
  EXPECT_NE(with("something else"), "");
  EXPECT_THAT(refusal_to_load(folder.path() / "none"), ::testing::HasSubstr("the file is missing"));
  ArchiveWriter other;
  other.section("another thing", 1);
  const Bytes sealed = seal(other.content());
  EXPECT_THAT(with({sealed.begin(), sealed.end()}), ::testing::HasSubstr("another thing"));
}

}  // namespace
}  // namespace maploop::mapmatch
