// A graph with a sensor and a stage that the vehicle does not have: a second inertial unit, and a
// stage that uses it while the first one is silent. Declared, built and run with the same parts as
// the vehicle's graph.
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <thread>
#include <tuple>
#include <vector>

#include "runtime/vehicle/drivers/replay_driver.h"
#include "runtime/vehicle/graph/graph_stage.h"
#include "tests/runtime/vehicle/fake_sensors.h"

namespace maploop::vehicle {
namespace {

using testing::drive_start;

// The declaration: two drivers, one stage with a budget, its consumer, and the rings between them.
constexpr StageSpec second_imu = stages::optional_sensor("second imu");
constexpr StageSpec chooser{.name = "chooser",
                            .runs = "choice of an inertial unit",
                            .released = "inertial sample",
                            .budget = milliseconds(1)};
constexpr RingSpec<ImuSample> first_ring{stages::imu, chooser, 256};
constexpr RingSpec<ImuSample> second_ring{second_imu, chooser, 256};
constexpr RingSpec<ImuSample> chosen_ring{chooser, stages::fusion, 1024};
constexpr auto example_rings = std::tie(first_ring, second_ring, chosen_ring);

// Passes the first unit's samples on; the second unit's if the first one has been silent for 50 ms.
class ImuChooser final : public GraphStage {
 public:
  explicit ImuChooser(Rings& rings) : GraphStage(chooser, rings), chosen_(outputs(chosen_ring)) {
    take(intake_, first_ring, [this](const ImuSample& sample) {
      last_ = sample.available;
      send(sample);
    });
    take(intake_, second_ring, [this](const ImuSample& sample) {
      if (sample.available - last_ > milliseconds(50)) send(sample);
    });
  }

  void run(runtime::DataClock&, Time begin, const std::stop_token& stop) override {
    last_ = begin;
    stop_ = stop;
    while (!stop.stop_requested()) {
      const std::uint32_t heard = bell().listen();
      const Time promised = intake_.promised();
      intake_.take_until(promised);
      if (promised == Time::max()) return;
      promise(promised + spec().budget);
      bell().wait(heard);
    }
  }
  std::size_t saved_bytes() const override { return sizeof(last_); }
  std::vector<RefusalCount> refusals() override { return {}; }

 private:
  void send(ImuSample sample) {
    sample.available += spec().budget;
    chosen_.push(sample, stop_);
  }
  void load(ArchiveReader& ar) override { ar(last_); }

  Outputs<ImuSample> chosen_;
  runtime::Intake intake_;
  std::stop_token stop_;
  Time last_{};
};

// 100 Hz for 2 s, with `value` as the yaw rate; without the samples from 0.5 s to 1.0 s if `gap`.
std::unique_ptr<sensors::Source<ImuSample>> unit(double value, Duration phase, bool gap) {
  auto make = [=](std::uint64_t i, ImuSample& sample) {
    const auto step = static_cast<std::int64_t>(gap && i >= 50 ? i + 50 : i);
    sample.stamp = sample.available = drive_start + phase + step * milliseconds(10);
    sample.yaw_rate = value;
  };
  return testing::fake_source<ImuSample>(gap ? 150 : 200, make);
}

std::vector<ImuSample> run() {
  Rings rings(example_rings, {"imu", "second imu", "chooser", "fusion"}, {});
  ReplayDriver<ImuSample> first(stages::imu, unit(1.0, {}, true), rings.outputs(first_ring));
  ReplayDriver<ImuSample> second(second_imu, unit(2.0, milliseconds(3), false),
                                 rings.outputs(second_ring));
  ImuChooser stage(rings);
  runtime::Edge<ImuSample>& chosen = *rings.consumer(chosen_ring);
  rings.check();
  runtime::DataClock clock = runtime::DataClock::virtual_time();
  clock.start(drive_start, Duration{});
  const std::stop_token stop;
  std::vector<std::jthread> threads;
  for (DriverBase* driver : {static_cast<DriverBase*>(&first), static_cast<DriverBase*>(&second)}) {
    driver->load_first();
    threads.emplace_back([&clock, &stop, driver] {
      driver->run(clock, stop);
      driver->finish();
    });
  }
  threads.emplace_back([&] {
    stage.run(clock, drive_start, stop);
    stage.finish();
  });
  threads.clear();  // joins
  std::vector<ImuSample> samples;
  for (; chosen.front() != nullptr; chosen.pop()) samples.push_back(*chosen.front());
  return samples;
}

TEST(SecondImu, BridgesTheFirstOneAndGivesTheSameSamplesOnEachRun) {
  const std::vector<ImuSample> samples = run();
  std::size_t of_second = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const Duration step = samples[i].available - samples[i - 1].available;
    EXPECT_GT(step, Duration::zero());
    EXPECT_LE(step, milliseconds(53));
    of_second += samples[i].yaw_rate == 2.0;
  }
  EXPECT_EQ(samples.size() - of_second, 150u);
  EXPECT_NEAR(static_cast<double>(of_second), 45.0, 1.0);
  const std::vector<ImuSample> again = run();
  ASSERT_EQ(again.size(), samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) EXPECT_EQ(again[i].stamp, samples[i].stamp) << i;
}

}  // namespace
}  // namespace maploop::vehicle
