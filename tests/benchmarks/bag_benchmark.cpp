// How fast recordings are read: all messages of real files, once the disk has delivered them.
//
//   MAPLOOP_DATA=../shared/data build/release/bin/bag_benchmark
//
// bytes_per_second counts the messages' bytes. tests/sensors/bag/other-readers reads the same files
// by other libraries, and states "seconds" and "bytes" of each (WITHOUT_HASH=1).
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "sensors/bag/message_reader.h"

namespace {

using maploop::sensors::MessageReader;

void read_all(benchmark::State& state, const std::filesystem::path& file) {
  std::size_t bytes = 0;
  for (auto _ : state) {
    const auto reader = maploop::sensors::open_messages(file, {});
    for (auto item = reader->next(); item != MessageReader::Item::end; item = reader->next()) {
      if (item == MessageReader::Item::message) bytes += reader->message().data.size();
    }
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes));
}

}  // namespace

int main(int count, char** words) {
  const char* const data = std::getenv("MAPLOOP_DATA");
  const std::filesystem::path bags = std::filesystem::path(data ? data : "../shared/data") / "bags";
  for (const char* name :
       {"kitti_0013/kitti13_zstd.mcap", "kitti_0013/kitti13_ros1_bz2.bag",
        "kitti_0013/kitti13_ros2_zstd_message/kitti13_ros2_zstd_message.db3",
        "recorded/imu_phidgets_upside_down.bag", "recorded/pj_rosbag2_test_0.db3"}) {
    if (exists(bags / name))
      benchmark::RegisterBenchmark(name, [file = bags / name](benchmark::State& state) {
        read_all(state, file);
      })->Unit(benchmark::kMillisecond);
  }
  benchmark::Initialize(&count, words);
  benchmark::RunSpecifiedBenchmarks();
}
