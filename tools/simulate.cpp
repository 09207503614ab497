// maploop simulate: a drive through a generated town.
#include "tools/simulate/simulation.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <string>

#include "msgs/time.h"
#include "tools/commands.h"
#include "tools/option_checks.h"
#include "tools/terminal.h"

namespace maploop::tools {
namespace {

struct SimulateOptions {
  std::filesystem::path out;
  simulate::SimulationOptions drive;
};

// A line that is overwritten on a terminal, a line every 10 s elsewhere.
class FrameProgress {
 public:
  void show(std::size_t done, std::size_t all) {
    const auto now = Clock::now();
    if (now < next_ && done < all) return;
    next_ = now + std::chrono::milliseconds(terminal_ ? 200 : 10'000);
    const double seconds = to_seconds(now - begin_);
    const double left = seconds / static_cast<double>(done) * static_cast<double>(all - done);
    std::fprintf(stderr, "%s%5zu of %zu frames, %.1f a second, %.0f s left %s",
                 terminal_ ? "\r" : "", done, all, static_cast<double>(done) / seconds, left,
                 terminal_ && done < all ? "" : "\n");
  }

 private:
  using Clock = std::chrono::steady_clock;
  bool terminal_ = isatty(STDERR_FILENO) != 0;
  Clock::time_point begin_ = Clock::now(), next_ = begin_ + std::chrono::seconds(1);
};

int simulate_command(const SimulateOptions& options) {
  note_interrupts();
  FrameProgress progress;
  const bool complete =
      simulate::simulate_drive(options.out, options.drive, [&](std::size_t done, std::size_t all) {
        progress.show(done, all);
        return !interrupted();
      });
  if (!complete) {
    std::cerr << "broken off; nothing is left of it\n";
    return 130;
  }
  const auto drive = options.out / "town_extract", map = options.out / "map.osm";
  std::cout << "wrote " << options.out.string() << "; to see it:\n  maploop replay "
            << drive.string() << " --map " << map.string() << '\n';
  return 0;
}

}  // namespace

void add_simulate(CLI::App& app, Command& command) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* sub = app.add_subcommand(
      "simulate", "Make a drive through a generated town: cameras, LiDAR, IMU, map and truth");
  sub->add_option("--out", options->out,
                  "New folder for the drive, in KITTI's layout (25 MB a second)")
      ->required();
  sub->add_option("--seconds", options->drive.seconds, "How long the drive takes")
      ->check(number_in(1.0, 3600.0))
      ->capture_default_str();
  sub->add_option("--seed", options->drive.seed, "Another seed, another town and drive")
      ->capture_default_str();
  const std::map<std::string, simulate::ImuGrade> grades{{"tactical", simulate::ImuGrade::tactical},
                                                         {"mems", simulate::ImuGrade::mems}};
  sub->add_option_function<std::string>(
         "--imu-grade",
         [options, grades](const std::string& name) { options->drive.imu = grades.at(name); },
         "tactical or mems")
      ->check(CLI::IsMember({"tactical", "mems"}))
      ->default_str("tactical");
  sub->callback(
      [options, &command] { command = [options] { return simulate_command(*options); }; });
}

}  // namespace maploop::tools
