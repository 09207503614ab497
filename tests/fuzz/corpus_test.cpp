// Each fuzz target on its corpus and on damaged copies of it, without clang. (tools/fuzz looks
// further: its inputs follow what they reach.) MAPLOOP_FUZZ_ROUNDS copies of each file; default 50.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "tests/support/damaged_text.h"
#include "tests/support/real_data.h"

// Each target's file is compiled with its function named after it.
#define MAPLOOP_FUZZ_TARGETS(f)                                                             \
  f(archive) f(bag) f(calibration) f(capture) f(cloud) f(corrections) f(doubts) f(endpoint) \
      f(folders) f(gnss) f(heights) f(image) f(kitti) f(log) f(messages) f(ncom) f(network) \
          f(nmea) f(ntrip) f(osm) f(recording) f(ros) f(rtcm3) f(rules) f(stream) f(tables) \
              f(tiles) f(toml) f(tracks) f(ubx) f(velodyne) f(xsens)
#define MAPLOOP_DECLARE(name) \
  extern "C" int fuzz_##name(const std::uint8_t* data, std::size_t size);
#define MAPLOOP_LIST(name) Target{#name, fuzz_##name},

MAPLOOP_FUZZ_TARGETS(MAPLOOP_DECLARE)

namespace maploop::fuzz {
namespace {

struct Target {
  const char* name;
  int (*run)(const std::uint8_t* data, std::size_t size);
};

// The test's name has it; an address would be another one each time.
void PrintTo(const Target& target, std::ostream* stream) {
  *stream << target.name;
}

constexpr Target targets[] = {MAPLOOP_FUZZ_TARGETS(MAPLOOP_LIST)};

// In the order of their names, after two that any target gets.
std::vector<std::string> corpus(const std::string& target) {
  const auto folder = testing::source("tests/fuzz/corpus") / target;
  std::vector<std::filesystem::path> files;
  if (std::filesystem::exists(folder)) {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> inputs{"", std::string(200, '\0')};
  for (const auto& file : files) {
    std::ifstream in(file, std::ios::binary);
    inputs.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return inputs;
}

void run(const Target& target, const std::string& input) {
  target.run(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
}

class Corpus : public ::testing::TestWithParam<Target> {};

TEST_P(Corpus, DoesNoHarm) {
  const char* const said = std::getenv("MAPLOOP_FUZZ_ROUNDS");
  const int rounds = said != nullptr ? std::atoi(said) : 50;
  std::mt19937 random(20110926);
  const std::string alphabet{"\0\x01\x7f\x80\xff 09.-eE\n", 13};
  for (const std::string& input : corpus(GetParam().name)) {
    run(GetParam(), input);
    for (int round = 0; round < rounds; ++round)
      run(GetParam(), testing::damaged(input, random, 50, alphabet));
  }
}

INSTANTIATE_TEST_SUITE_P(OfTarget, Corpus, ::testing::ValuesIn(targets),
                         [](const auto& of) { return std::string(of.param.name); });

}  // namespace
}  // namespace maploop::fuzz
