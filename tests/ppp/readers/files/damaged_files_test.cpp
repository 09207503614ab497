// Tests the readers on damaged copies of real files: each gives an error with its file, or a
// counted refusal.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ppp/gnss_files.h"
#include "tests/support/damaged_text.h"
#include "tests/support/real_data.h"

namespace maploop::ppp {
namespace {

constexpr std::string_view alphabet = "0123456789.-+eE:naif \n\r\t&>*#PGRE";

// Returns the start of a file's text, up to the end of a line.
std::string part(const std::string& name, std::size_t size) {
  std::string text = read_file(maploop::testing::real_data() / "gnss" / name);
  if (text.size() > size) text.resize(text.rfind('\n', size) + 1);
  return text;
}

void expect_usable(const GnssFiles& files) {
  for (const auto& o : files.observations) {
    for (const auto& epoch : o.epochs) {
      for (const auto& s : epoch.satellites) {
        ASSERT_LE(s.first + s.count, epoch.signals.size());
        ASSERT_LT(s.satellite.slot(), satellite_slots);
      }
      for (const Signal& s : epoch.signals) {
        ASSERT_TRUE(std::isfinite(s.code) && std::isfinite(s.phase) && std::isfinite(s.doppler));
        ASSERT_TRUE(s.code == 0.0 || (s.code > 1e7 && s.code < 1e8));
      }
    }
  }
  for (const auto& o : files.orbits) {
    for (const auto& [satellite, points] : o.points) ASSERT_EQ(points.size(), o.epochs.size());
  }
  for (const auto& n : files.navigation) {
    for (const auto& m : n.kepler) ASSERT_TRUE(m.e < 0.5 && m.sqrt_a > 4000.0);
  }
}

void feed(const std::string& name, std::size_t size, int rounds) {
  const std::string text = part(name, size);
  std::mt19937 random(20200625);
  int errors = 0;
  for (int round = 0; round < rounds; ++round) {
    GnssFiles files;
    try {
      parse_into(maploop::testing::damaged(text, random, 400, alphabet), "damaged", files);
      expect_usable(files);
    } catch (const ReadError& error) {
      ASSERT_EQ(std::string(error.what()).find("damaged:"), 0U) << error.what();
      ++errors;
    }
  }
  EXPECT_GT(errors, rounds / 20) << name;
}

TEST(DamagedGnssFile, Observations) {
  MAPLOOP_REQUIRE_REAL_DATA();
  feed("parser_samples/zegv0010.21o", 20000, 600);
  feed("kamakura_kinematic/SEPT265G.21O.gz", 20000, 600);
}

TEST(DamagedGnssFile, CompactObservations) {
  MAPLOOP_REQUIRE_REAL_DATA();
  feed("parser_samples/zegv0010.21d", 20000, 600);
  feed("parser_samples/KUNZ00CZE.crx", 20000, 600);
}

TEST(DamagedGnssFile, Navigation) {
  MAPLOOP_REQUIRE_REAL_DATA();
  feed("riverside_drive/COM3_200712.nav.gz", 10000, 600);
  feed("kamakura_kinematic/SEPT2650.21P.gz", 10000, 600);
}

TEST(DamagedGnssFile, Products) {
  MAPLOOP_REQUIRE_REAL_DATA();
  feed("kamakura_kinematic/COD0MGXFIN_20212650000_01D_05M_ORB.SP3.gz", 20000, 600);
  feed("esbc_static/GRG0MGXFIN_20201770000_01D_30S_CLK.CLK.gz", 20000, 600);
  feed("kamakura_kinematic/COD0MGXFIN_20212650000_01D_01D_OSB.BIA.gz", 30000, 600);
}

TEST(DamagedGnssFile, Models) {
  MAPLOOP_REQUIRE_REAL_DATA();
  feed("models/igs14_rebuilt_GE.atx.gz", 20000, 600);
  feed("parser_samples/igs14_small.atx.gz", 20000, 400);
  feed("models/OLOAD_GO.BLQ.gz", 10000, 600);
}

TEST(DamagedGnssFile, GzipThatIsCutOrFlipped) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const maploop::testing::TemporaryFolder folder;
  const auto whole = maploop::testing::real_data() / "gnss/riverside_drive/COM3_200712.nav.gz";
  const auto copy = folder.path() / "cut.gz";
  std::filesystem::copy_file(whole, copy);
  std::filesystem::permissions(copy, std::filesystem::perms::owner_all);
  std::filesystem::resize_file(copy, std::filesystem::file_size(copy) / 2);
  EXPECT_THROW(read_file(copy), ReadError);
  EXPECT_THROW(read_file(folder.path() / "missing"), ReadError);
  EXPECT_THROW(read_file(folder.path()), ReadError);
}

}  // namespace
}  // namespace maploop::ppp
