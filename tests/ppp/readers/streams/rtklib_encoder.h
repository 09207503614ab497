// Runs RTKLIB's encoder of RTCM 3 as an independent implementation.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <system_error>
#include <thread>

#include "ppp/readers/files/lines.h"
#include "tests/support/process.h"

namespace maploop::testing {

// Returns RTKLIB's encoding of a recording as messages of these numbers.
inline std::string encoded_by_rtklib(const std::filesystem::path& ubx, const std::string& numbers) {
  const std::string file = ubx.string() + "." + numbers.substr(0, 4);
  Process str2str({"str2str", "-in", "file://" + ubx.string() + "#ubx", "-out",
                   "file://" + file + "#rtcm3", "-msg", numbers});
  // str2str does not stop at the end of the file. It writes through to the file, and does not
  // always end when it is asked to, so that it is ended by force when this function returns.
  std::uintmax_t size = 0;
  for (int i = 0, still = 0; i < 300 && still < 15; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    std::error_code missing;
    const std::uintmax_t now = std::filesystem::file_size(file, missing);
    still = !missing && now == size && now > 0 ? still + 1 : 0;
    size = missing ? 0 : now;
  }
  return ppp::read_file(file);
}

}  // namespace maploop::testing

#define MAPLOOP_REQUIRE_RTKLIB()                                                                   \
  if (maploop::testing::run({"sh", "-c", "command -v str2str && command -v convbin"}).status != 0) \
  GTEST_SKIP() << "SKIPPED, NOT TESTED: RTKLIB's str2str and convbin are not installed"
