// Milliseconds a scan of the recorded drive, one thread, preparation included, beside the alignment
// alone of PCL's GICP on samples of 0.25 m: bin/lidar_benchmark
#include <benchmark/benchmark.h>

#include <vector>

#include "estimators/lidar/lidar_odometry.h"
#include "estimators/lidar/scan_preparation.h"
#include "tests/estimators/lidar/drive_scans.h"
#include "tools/odometry/pcl_registration.h"

namespace maploop {
namespace {

constexpr std::size_t scan_count = 40;

bool drive_missing(benchmark::State& state) {
  if (!testing::drive_0013().empty()) return false;
  state.SkipWithError(
      "the recorded drive is missing; set MAPLOOP_DATA and run tools/restore-drive");
  return true;
}

void process_scan(benchmark::State& state) {
  if (drive_missing(state)) return;
  const sensors::KittiDrive drive(testing::drive_0013());
  const auto scans = testing::read_scans(drive, scan_count);
  const auto anew = [&] {
    lidar::LidarOdometry odometry(drive.calibration().T_body_velo,
                                  testing::lidar_parameters(drive));
    odometry.process(&scans[0], nullptr);
    odometry.process(&scans[1], nullptr);
    return odometry;
  };
  lidar::LidarOdometry odometry = anew();
  std::size_t i = 2;
  for (auto _ : state) {
    if (i == scans.size()) {  // the drive begins anew: not a scan to be timed
      state.PauseTiming();
      odometry = anew();
      i = 2;
      state.ResumeTiming();
    }
    benchmark::DoNotOptimize(odometry.process(&scans[i++], nullptr));
  }
}

void align_pcl(benchmark::State& state) {
  if (drive_missing(state)) return;
  const sensors::KittiDrive drive(testing::drive_0013());
  const auto scans = testing::read_scans(drive, scan_count);
  lidar::LidarParameters parameters = testing::lidar_parameters(drive);
  parameters.sample_voxel = 0.25;
  parameters.max_samples = 131'072;
  lidar::ScanPreparation preparation(drive.calibration().T_body_velo, parameters);
  std::vector<lidar::PreparedScan> prepared(scans.size());
  for (std::size_t k = 0; k < scans.size(); ++k)
    preparation.prepare(scans[k], scans[k].stamp, {{12.5, 0.0, 0.0}, Eigen::Vector3d::Zero()},
                        &prepared[k]);
  Eigen::Isometry3d seed = Eigen::Isometry3d::Identity();
  seed.translation().x() = 1.25;
  odometry::PclRegistration gicp(odometry::Method::pcl_gicp);
  std::size_t i = 1;
  for (auto _ : state) {
    benchmark::DoNotOptimize(gicp.align(prepared[i].points, prepared[i - 1].points, seed));
    if (++i == scans.size()) i = 1;
  }
}

BENCHMARK(process_scan)->Iterations(114)->Unit(benchmark::kMillisecond);
BENCHMARK(align_pcl)->Iterations(38)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace maploop

BENCHMARK_MAIN();
