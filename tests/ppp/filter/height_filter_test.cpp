// Tests the PPP filter with the height of the ground, on a real drive over a made tile.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <optional>

#include "msgs/frames.h"
#include "ppp/models/geodesy.h"
#include "ppp/ppp_setup.h"
#include "tests/support/broken_archives.h"
#include "tests/support/real_data.h"

namespace maploop::ppp {
namespace {

using maploop::testing::TemporaryFolder;

constexpr std::size_t epochs = 90;

// The drive in Riverside, with flat ground as high as its road, or without heights.
class Drive {
 public:
  explicit Drive(std::optional<double> ground = {}) {
    const auto data = maploop::testing::real_data() / "gnss/riverside_drive";
    read_into(data / "COM3_200712.obs.gz", files_);
    read_into(data / "COM3_200712.nav.gz", files_);
    SetupOptions options;
    options.parameters.systems = "GEC";
    if (ground) {
      write_tile(static_cast<std::int16_t>(std::lround(*ground)));
      options.heights = folder_.path().string();
      options.geoid = "none";
    }
    setup_ = std::make_unique<PppSetup>(files_, options);
  }
  MapAidedFilter filter() const { return setup_->make_map_aided_filter(); }
  const Epoch& epoch(std::size_t i) const { return setup_->observations().epochs.at(i); }

 private:
  void write_tile(std::int16_t height) const {
    std::ofstream out(folder_.path() / "N33W118.hgt", std::ios::binary);
    const auto value = static_cast<std::uint16_t>(height);
    for (int i = 0; i < 1201 * 1201; ++i) {
      out.put(static_cast<char>(value >> 8U)).put(static_cast<char>(value & 0xffU));
    }
  }

  TemporaryFolder folder_;
  GnssFiles files_;
  std::unique_ptr<PppSetup> setup_;
};

double height_of(const PppSolution& s) {
  return geodetic_from_ecef(s.position).height;
}

double sigma_up(const PppSolution& s) {
  const Eigen::Vector3d up = rotation_enu_ecef(geodetic_from_ecef(s.position)).row(2);
  return std::sqrt(up.dot(s.covariance * up));
}

// The height at the drive's first epochs, without a model of the ground.
double road() {
  const Drive drive;
  MapAidedFilter filter = drive.filter();
  for (std::size_t i = 0; i < epochs; ++i) filter.process(drive.epoch(i));
  EXPECT_EQ(filter.solution().height_use, HeightUse::not_asked);
  return height_of(filter.solution());
}

TEST(HeightsInTheFilter, MakeTheHeightMoreCertainFromTheFirstEpoch) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Drive with(road()), without;
  MapAidedFilter aided = with.filter(), free = without.filter();
  int used = 0;
  for (std::size_t i = 0; i < epochs; ++i) {
    used += aided.process(with.epoch(i)).height_use == HeightUse::used;
    free.process(without.epoch(i));
    ASSERT_LE(sigma_up(aided.solution()), sigma_up(free.solution()) + 1e-6) << i;
    if (i == 0) {
      EXPECT_LT(sigma_up(aided.solution()), 0.94 * sigma_up(free.solution()));
    }
  }
  EXPECT_GT(used, 60);
}

TEST(HeightsInTheFilter, AreLeftOutOnABridgeOfTheMapAndTwoSecondsLonger) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Drive drive(road());
  MapAidedFilter filter = drive.filter();
  MapFeedback bridge;
  bridge.off_ground = true;
  for (std::size_t i = 0; i < 6; ++i) {
    filter.process(drive.epoch(i));
    EXPECT_EQ(filter.solution().height_use == HeightUse::off_ground, i >= 2 && i <= 4) << i;
    bridge.stamp = to_utc(drive.epoch(i).time);
    if (i == 1 || i == 2) filter.note_road(bridge);
  }
}

TEST(HeightsInTheFilter, GoOnFromAnArchiveWithTheSameBits) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Drive drive(road());
  MapAidedFilter filter = drive.filter(), resumed = drive.filter();
  for (std::size_t i = 0; i < 40; ++i) filter.process(drive.epoch(i));
  const Bytes archive = maploop::testing::saved(filter);
  EXPECT_LT(archive.size(), MapAidedFilter::largest_archive);
  maploop::testing::load(archive, resumed);
  for (std::size_t i = 40; i < 60; ++i) {
    filter.process(drive.epoch(i));
    resumed.process(drive.epoch(i));
    ASSERT_EQ(filter.solution().position, resumed.solution().position);
  }
}

}  // namespace
}  // namespace maploop::ppp
