// Drives that the tests of a process share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "tests/support/real_data.h"
#include "tools/simulate/simulation.h"

namespace maploop::simulate {

// Returns the folder of a drive with these options, which is made once per process and name.
inline std::filesystem::path made(const std::string& name, const SimulationOptions& options) {
  static const maploop::testing::TemporaryFolder temporary;
  std::filesystem::path folder = temporary.path() / name;
  if (!std::filesystem::exists(folder)) {
    EXPECT_TRUE(simulate_drive(folder, options));
  }
  return folder;
}

inline std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Expects that both folders have the same files with the same bytes.
inline void expect_same_files(const std::filesystem::path& one, const std::filesystem::path& two) {
  namespace fs = std::filesystem;
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(one)) {
    if (!entry.is_regular_file()) continue;
    ++files;
    const fs::path name = fs::relative(entry.path(), one);
    ASSERT_TRUE(fs::is_regular_file(two / name)) << name;
    EXPECT_TRUE(content(entry.path()) == content(two / name)) << name;
  }
  const auto of_two = fs::recursive_directory_iterator(two);
  EXPECT_EQ(files, std::count_if(begin(of_two), end(of_two),
                                 [](const auto& entry) { return entry.is_regular_file(); }));
}

}  // namespace maploop::simulate
