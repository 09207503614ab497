// Runs the `maploop` command in tests, as its users do.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/process.h"
#include "tests/support/real_data.h"

namespace maploop::testing {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using Words = std::vector<std::string>;

inline ProcessResult run_maploop(Words words) {
  words.insert(words.begin(), maploop_command());
  return run(words);
}

inline nlohmann::json read_json(const std::filesystem::path& file) {
  return nlohmann::json::parse(std::ifstream(file));
}

inline std::string read_file(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

// Returns the hashes of the channels in a replay's JSON; channels without a hash are left out.
inline std::map<std::string, std::string> hashes(const nlohmann::json& result) {
  std::map<std::string, std::string> all;
  for (const auto& [name, channel] : result["channels"].items()) {
    if (channel["hash"] != "") all[name] = channel["hash"];
  }
  return all;
}

class CommandTest : public ::testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name)) << text;
    return file(name);
  }

  // Replays a recording without LCM; returns the JSON of the run, which must succeed.
  nlohmann::json replay(const std::string& recording, Words options) const {
    options.insert(options.begin(),
                   {"replay", recording, "--no-lcm", "--json", file("result.json")});
    const ProcessResult result = run_maploop(options);
    EXPECT_EQ(result.status, 0) << result.error;
    return read_json(file("result.json"));
  }

  // Returns the error of a replay that must fail.
  static std::string refusal(const std::string& recording, Words options) {
    options.insert(options.begin(), {"replay", recording, "--no-lcm"});
    const ProcessResult result = run_maploop(options);
    EXPECT_EQ(result.status, 1) << result.out;
    return result.error;
  }

  TemporaryFolder folder_;
};

// A CommandTest of the recorded drive.
class DriveTest : public CommandTest {
 protected:
  void SetUp() override { MAPLOOP_REQUIRE_DRIVE(); }

  static std::string drive() { return drive_0013().string(); }
};

}  // namespace maploop::testing
