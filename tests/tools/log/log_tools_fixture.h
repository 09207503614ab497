// Provides a recorded log in a separate folder, for the tests of the log tools.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/real_data.h"
#include "tests/tools/log/small_log.h"
#include "tools/log/log_types.h"

namespace maploop::lcm_log {

using std::filesystem::path;

inline const schema::Schema& types() {
  static const schema::Schema schema = load_types({});
  return schema;
}

template <class Error, class F>
std::string error_of(const F& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class LogToolsTest : public ::testing::Test {
 protected:
  LogToolsTest() { record(log_, drive_); }

  void damage(std::size_t offset, std::uint8_t mask) {
    auto bytes = read_bytes(log_);
    bytes[offset] ^= mask;
    write_bytes(log_, bytes);
  }

  const maploop::testing::TemporaryFolder folder_;
  const path log_ = folder_.path() / "a.lcmlog";
  const path out_ = folder_.path() / "out.lcmlog";
  const std::vector<TestEvent> drive_ = small_drive();
  const std::vector<std::size_t> offsets_ = event_offsets(drive_);
};

}  // namespace maploop::lcm_log
