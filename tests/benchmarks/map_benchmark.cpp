// Map matching and its parts on real maps: a fix, a search for near links, and loading.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>

#include "mapmatch/matcher.h"
#include "mapmatch/network_file.h"
#include "tools/match/track_file.h"

namespace maploop {
namespace {

std::filesystem::path data() {
  const char* folder = std::getenv("MAPLOOP_DATA");
  return folder ? folder : "../shared/data";
}

std::filesystem::path karlsruhe() {
  return data() / "maps/karlsruhe_2012-04.osm.pbf";
}

void a_fix_at_10_Hz(benchmark::State& state) {
  const mapmatch::RoadNetwork network(mapmatch::open_network(karlsruhe()));
  const mapmatch::RuleBases rules = mapmatch::read_rule_bases(mapmatch::default_rules());
  const match::Track track = match::read_track(data() / "kitti_odometry/oxts/00.csv.gz", {});
  mapmatch::Matcher matcher(network, rules, {});
  std::size_t i = 0;
  Duration later{};  // the drive again, an hour later
  for (auto _ : state) {
    mapmatch::VehicleFix fix = track[i];
    fix.stamp += later;
    benchmark::DoNotOptimize(matcher.add(fix).probability);
    if (++i == track.size()) {
      i = 0;
      later += std::chrono::hours(1);
    }
  }
}

mapmatch::Box about(const Eigen::Vector2d& p) {
  return {p.x() - 40.0, p.y() - 40.0, p.x() + 40.0, p.y() + 40.0};
}

void near_segments(benchmark::State& state) {
  const mapmatch::RoadNetwork network(mapmatch::open_network(karlsruhe()));
  std::size_t i = 0, found = 0;
  for (auto _ : state) {
    const auto& v = network.vertex(static_cast<std::uint32_t>(i));
    network.index().visit(about(v.position()), [&](const mapmatch::IndexedSegment&) { ++found; });
    i = (i + 7919) % network.data().vertices.size();
  }
  benchmark::DoNotOptimize(found);
}

void load_pbf(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(mapmatch::RoadNetwork(mapmatch::open_network(karlsruhe())).size());
}

void load_own_file(benchmark::State& state) {
  const auto file = std::filesystem::temp_directory_path() / "maploop_benchmark.network";
  mapmatch::save_network(file, mapmatch::open_network(karlsruhe()));
  for (auto _ : state)
    benchmark::DoNotOptimize(mapmatch::RoadNetwork(mapmatch::open_network(file)).size());
  std::filesystem::remove(file);
}

BENCHMARK(a_fix_at_10_Hz);
BENCHMARK(near_segments);
BENCHMARK(load_pbf)->Unit(benchmark::kMillisecond);
BENCHMARK(load_own_file)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace maploop

BENCHMARK_MAIN();
