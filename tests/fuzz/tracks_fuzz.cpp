// Tracks as CSV, GPX, NMEA and TUM, and trajectories to be scored, by the first byte.
#include <cmath>
#include <stdexcept>

#include "tests/fuzz/fuzz_input.h"
#include "tools/evaluate/trajectory_file.h"
#include "tools/match/track_file.h"

using namespace maploop;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const auto kind = input.byte() % 5U;
  const auto bytes = input.rest();
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  match::TrackOptions options;
  options.origin = Geodetic{0.8, 0.1, 0.0};
  const fuzz::MemoryFile file(bytes.data(), bytes.size());
  try {
    switch (kind) {
      case 0:
        (void)match::parse_csv_track(text, "input", options);
        break;
      case 1:
        (void)match::parse_gpx_track(text, "input", options);
        break;
      case 2:
        (void)match::parse_nmea_track(text, "input", options);
        break;
      case 3:
        (void)match::parse_tum_track(text, "input", options);
        break;
      default:
        (void)evaluation::read_trajectory(file.path());
        break;
    }
  } catch (const std::runtime_error&) {
  }
  return 0;
}
