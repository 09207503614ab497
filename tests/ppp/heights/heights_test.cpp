// Tests the readers of heights: tiles of SRTM as they are distributed, the grid of the geoid, and
// both together.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <random>
#include <string>

#include "msgs/frames.h"
#include "msgs/input_file.h"
#include "ppp/heights/height_model.h"
#include "ppp/heights/zip_archive.h"
#include "tests/support/damaged_text.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::ppp {
namespace {

namespace fs = std::filesystem;
using maploop::testing::error_of;
using maploop::testing::TemporaryFolder;
using ::testing::HasSubstr;

constexpr int side = 1201;

// Makes a tile whose samples are height(row from the north, column).
template <class Height>
std::string tile(Height&& height) {
  std::string bytes;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const auto value = static_cast<std::uint16_t>(static_cast<std::int16_t>(height(row, column)));
      bytes += static_cast<char>(value >> 8U);
      bytes += static_cast<char>(value & 0xffU);
    }
  }
  return bytes;
}

void write(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

void append(std::string& bytes, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xffU);
}

// Makes an archive of one stored file, byte by byte as the specification has it.
std::string archive_of(const std::string& name, const std::string& content, std::uint32_t checksum,
                       std::uint32_t flags = 0) {
  std::string entry;
  append(entry, flags, 2);
  append(entry, 0, 2);  // stored
  append(entry, 0, 4);  // time
  append(entry, checksum, 4);
  append(entry, content.size(), 4);
  append(entry, content.size(), 4);
  append(entry, name.size(), 2);
  append(entry, 0, 2);
  std::string bytes("PK\x03\x04\x14\x00", 6);
  bytes += entry + name + content;
  const std::size_t directory = bytes.size();
  bytes += std::string("PK\x01\x02\x14\x00\x14\x00", 8) + entry;
  bytes += std::string(14, '\0') + name;
  const std::size_t size = bytes.size() - directory;
  bytes += std::string("PK\x05\x06\x00\x00\x00\x00\x01\x00\x01\x00", 12);
  append(bytes, size, 4);
  append(bytes, directory, 4);
  append(bytes, 0, 2);
  return bytes;
}

constexpr std::uint32_t checksum_of_abc = 0x352441c2;  // CRC-32 of "abc"

template <class Value>
void append_big_endian(std::string& bytes, Value value) {
  const auto raw = std::bit_cast<std::array<char, sizeof(Value)>>(value);
  bytes.append(raw.rbegin(), raw.rend());
}

// Makes a grid around the earth every 90 degrees, whose height is that of its column.
std::string geoid_of(const std::array<float, 4>& columns) {
  std::string bytes;
  for (const double value : {-90.0, -180.0, 90.0, 90.0}) append_big_endian(bytes, value);
  append_big_endian(bytes, std::int32_t{3});
  append_big_endian(bytes, std::int32_t{4});
  for (int row = 0; row < 3; ++row) {
    for (const float value : columns) append_big_endian(bytes, value);
  }
  return bytes;
}

Geodetic spot(double latitude, double longitude) {
  return {radians(latitude), radians(longitude), 0.0};
}

TEST(HeightTiles, TheirNamesAreTheirCorners) {
  EXPECT_EQ(corner_of("N49E011.hgt"), (TileCorner{49, 11}));
  EXPECT_EQ(corner_of("a/N42W001.SRTMGL1.hgt.zip"), (TileCorner{42, -1}));
  EXPECT_EQ(corner_of("s01w180.hgt.gz"), (TileCorner{-1, -180}));
  for (const char* other : {"N49E011.tif", "N90E000.hgt", "S91E000.hgt", "N49E180.hgt",
                            "N4xE011.hgt", "49E011.hgt", "N49E0111.hgt", ".hgt", ""}) {
    EXPECT_FALSE(corner_of(other)) << other;
  }
}

TEST(HeightTiles, AreInterpolatedFromTheNorthernEdge) {
  const HeightTile t({49, 11}, tile([](int row, int column) { return 2 * row - column; }));
  EXPECT_EQ(t.at(50.0, 11.0)->height, 0.0) << "the first sample is in the north-west";
  EXPECT_EQ(t.at(49.0, 12.0)->height, 1200.0) << "the last is in the south-east";
  const auto between = t.at(50.0 - 10.25 / 1200.0, 11.0 + 7.5 / 1200.0);
  ASSERT_TRUE(between);
  EXPECT_NEAR(between->height, 2 * 10.25 - 7.5, 1e-9);
  EXPECT_NEAR(between->per_latitude, -2400.0, 1e-6);
  EXPECT_NEAR(between->per_longitude, -1200.0, 1e-6);
  EXPECT_FALSE(t.at(50.001, 11.5));
  EXPECT_FALSE(t.at(49.5, std::nan("")));
}

TEST(HeightTiles, TheSlopeIsTheDerivative) {
  const HeightTile t(
      {49, 11}, tile([](int row, int column) { return (row * row + 3 * row * column) % 997; }));
  for (const double shift : {0.1, 0.4, 0.9}) {
    const double latitude = 49.3 + shift / 1200.0, longitude = 11.7 + (1.0 - shift) / 1200.0;
    constexpr double step = 1e-6;
    const auto h = t.at(latitude, longitude);
    EXPECT_NEAR(
        (t.at(latitude + step, longitude)->height - t.at(latitude - step, longitude)->height) /
            (2.0 * step),
        h->per_latitude, 0.5);
    EXPECT_NEAR(
        (t.at(latitude, longitude + step)->height - t.at(latitude, longitude - step)->height) /
            (2.0 * step),
        h->per_longitude, 0.5);
  }
}

TEST(HeightTiles, AVoidSampleHasNoHeightAround) {
  const HeightTile t(
      {0, 0}, tile([](int row, int column) { return row == 600 && column == 600 ? -32768 : 5; }));
  EXPECT_FALSE(t.at(0.5 + 0.4 / 1200, 0.5 - 0.4 / 1200));
  EXPECT_TRUE(t.at(0.5 + 1.4 / 1200, 0.5 - 0.4 / 1200));
}

TEST(HeightTiles, AnErrorNamesTheFileAndWhatIsWrong) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "N49E011.hgt";
  write(file, "short");
  EXPECT_THAT(error_of([&] { read_height_tile(file); }),
              HasSubstr("N49E011.hgt: 5 bytes are no tile"));
  write(file, "PK this is cut");
  EXPECT_THAT(error_of([&] { read_height_tile(file); }), HasSubstr("ZIP archive has no directory"));
  EXPECT_THAT(error_of([&] { read_height_tile(folder.path() / "heights.hgt"); }),
              HasSubstr("is not named after its south-western corner"));
  EXPECT_THAT(error_of([&] { read_height_tile(folder.path() / "N50E011.hgt"); }),
              HasSubstr("the file is missing"));
}

TEST(ZipArchive, GivesTheFileWithThatEnding) {
  EXPECT_EQ(unpacked(archive_of("A.HGT", "abc", checksum_of_abc), ".hgt", 3), "abc");
}

TEST(ZipArchive, SaysWhyItIsRefused) {
  const auto error = [](const std::string& bytes, std::size_t limit = 100) {
    return error_of([&] { unpacked(bytes, ".hgt", limit); });
  };
  EXPECT_THAT(error(archive_of("a.txt", "abc", checksum_of_abc)), HasSubstr("contains no file"));
  EXPECT_THAT(error(archive_of("a.hgt", "abd", checksum_of_abc)), HasSubstr("checksum differs"));
  EXPECT_THAT(error(archive_of("a.hgt", "abc", checksum_of_abc, 1)), HasSubstr("encrypted"));
  EXPECT_THAT(error(archive_of("a.hgt", "abc", checksum_of_abc), 2), HasSubstr("at most 2"));
}

TEST(ZipArchive, DamagedArchivesAreRefused) {
  const std::string whole = archive_of("N49E011.hgt", std::string(300, 'a'), 0);
  std::mt19937 random(5);
  for (int round = 0; round < 2000; ++round) {
    const std::string bytes = maploop::testing::damaged(whole, random, 60, {"\0\x01PK\xff", 5});
    EXPECT_THROW(unpacked(bytes, ".hgt", 1000), std::runtime_error);
  }
}

TEST(GeoidGrids, GoAroundTheEarth) {
  const GeoidGrid grid(geoid_of({10.0F, 20.0F, 40.0F, 30.0F}));
  EXPECT_EQ(grid.at(10.0, -180.0), 10.0);
  EXPECT_EQ(grid.at(-90.0, 0.0), 40.0);
  EXPECT_EQ(grid.at(90.0, 45.0), 35.0);
  EXPECT_EQ(grid.at(0.0, 135.0), 20.0) << "between the last column and the first";
  EXPECT_FALSE(grid.at(91.0, 0.0));
}

TEST(GeoidGrids, OthersAreRefused) {
  const std::string whole = geoid_of({1.0F, 2.0F, 3.0F, 4.0F});
  std::string huge = whole;
  huge[32] = 0x7f;  // rows
  for (const std::string& bytes : {std::string(), whole.substr(1), whole + "x", huge}) {
    EXPECT_THAT(error_of([&] { GeoidGrid{bytes}; }), HasSubstr("no grid of the geoid"));
  }
}

TEST(GeoidGrids, Egm96HasItsKnownHeights) {
  if (!fs::exists(HeightModel::usual_geoid)) GTEST_SKIP() << "SKIPPED: proj-data is not installed";
  const GeoidGrid grid = read_geoid_grid(HeightModel::usual_geoid);
  // These are test points of NIMA for EGM96 (TR8350.2); the tolerance is that of interpolation.
  EXPECT_NEAR(*grid.at(38.6281550, 269.7791550), -31.628, 0.05);
  EXPECT_NEAR(*grid.at(-14.6212170, 305.0211140), -2.969, 0.05);
  EXPECT_NEAR(*grid.at(46.8743190, 102.4487290), -43.575, 0.05);
  EXPECT_NEAR(*grid.at(0.0, 0.0), 17.16, 0.05);
}

TEST(HeightModels, AddTheGeoidAndTurnTheSlopeToMetres) {
  const TemporaryFolder folder;
  write(folder.path() / "N00E000.hgt", tile([](int row, int) { return 1200 - row; }));
  write(folder.path() / "geoid.gtx", geoid_of({7.0F, 7.0F, 7.0F, 7.0F}));
  const HeightModel model(folder.path(), folder.path() / "geoid.gtx");
  EXPECT_TRUE(model.above_ellipsoid());
  const Ground ground = model.at(spot(0.5, 0.5));
  ASSERT_EQ(ground.use, HeightUse::used);
  EXPECT_NEAR(ground.height, 607.0, 1e-6);
  EXPECT_NEAR(ground.slope.y(), 1200.0 / 111'195.0, 1e-6);
  EXPECT_NEAR(ground.slope.x(), 0.0, 1e-9);
  EXPECT_EQ(model.at(spot(-0.1, 0.5)).use, HeightUse::no_tile);
  EXPECT_EQ(HeightModel(folder.path(), "none").at(spot(0.5, 0.5)).height, 600.0);
}

TEST(HeightModels, ATileThatCannotBeReadIsToldAndTheOthersCount) {
  const TemporaryFolder folder;
  write(folder.path() / "N00E000.hgt", tile([](int, int) { return 3; }));
  write(folder.path() / "N00E001.hgt", "cut");
  const HeightModel model(folder.path(), "none");
  EXPECT_EQ(model.tile_count(), 2U);
  EXPECT_EQ(model.at(spot(0.5, 1.5)).use, HeightUse::unreadable);
  EXPECT_EQ(model.at(spot(0.5, 1.0)).use, HeightUse::unreadable) << "the seam is the eastern's";
  EXPECT_EQ(model.at(spot(0.5, 0.9)).use, HeightUse::used);
  ASSERT_EQ(model.problems().size(), 1U);
  EXPECT_THAT(model.problems()[0], HasSubstr("N00E001.hgt"));
}

TEST(HeightModels, KeepNoMoreThanFourTilesAndReadThemAgain) {
  const TemporaryFolder folder;
  for (int east = 0; east < 6; ++east) {
    write(folder.path() / ("N00E00" + std::to_string(east) + ".hgt"),
          tile([east](int, int) { return east; }));
  }
  const HeightModel model(folder.path(), "none");
  for (int round = 0; round < 2; ++round) {
    for (int east = 0; east < 6; ++east) {
      EXPECT_EQ(model.at(spot(0.5, east + 0.5)).height, east);
    }
  }
}

TEST(HeightModels, ErrorsSayWhatIsNeeded) {
  const TemporaryFolder folder;
  EXPECT_THAT(error_of([&] { HeightModel(folder.path(), "none"); }),
              HasSubstr("has no tiles of heights: files such as N49E011.hgt"));
  write(folder.path() / "N00E000.hgt", "cut");
  EXPECT_THAT(error_of([&] { HeightModel(folder.path() / "N00E000.hgt", "none"); }),
              HasSubstr("3 bytes are no tile"));
  EXPECT_THAT(error_of([&] { HeightModel(folder.path(), folder.path() / "N00E000.hgt"); }),
              HasSubstr("no grid of the geoid"));
}

TEST(RealHeights, AreAsHighAsTheTownAndVoidInTheMountains) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const fs::path heights = maploop::testing::real_data() / "heights";
  const HeightModel model(heights, "none");
  EXPECT_EQ(model.tile_count(), 2U);
  // Lauf an der Pegnitz and Andorra la Vella, which maps state at 327 and 1023 m.
  EXPECT_NEAR(model.at(spot(49.5103, 11.2772)).height, 327.0, 15.0);
  EXPECT_NEAR(model.at(spot(42.5078, 1.5211)).height, 1023.0, 40.0);
  const HeightTile tile = read_height_tile(heights / "N42E001.hgt.zip");
  int voids = 0;
  for (int row = 0; row < 1200; ++row) {
    for (int column = 0; column < 1200; ++column) {
      voids += !tile.at(42.0 + (row + 0.5) / 1200, 1.0 + (column + 0.5) / 1200);
    }
  }
  EXPECT_GT(voids, 7652) << "squares with a void corner; so many samples are void";
  EXPECT_LT(voids, 4 * 7652);
}

}  // namespace
}  // namespace maploop::ppp
