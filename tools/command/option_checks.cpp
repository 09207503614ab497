#include "tools/command/option_checks.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "runtime/core/number_text.h"
#include "tools/command/output_check.h"

namespace maploop::tools {
namespace {

namespace fs = std::filesystem;

std::optional<double> finite(const std::string& text) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stopped != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

template <class Holds>
CLI::Validator number(const std::string& shown, const std::string& must, Holds holds) {
  return {[=](std::string& text) {
            const std::optional<double> value = finite(text);
            return value && holds(*value) ? std::string{} : "'" + text + "' is no number" + must;
          },
          shown};
}

[[noreturn]] void fail(const char* cannot, const std::string& path, const std::string& reason) {
  throw std::runtime_error(std::string(cannot) + " '" + path + "': " + reason);
}

template <class Allowed>
CLI::Validator existing(const std::string& shown, const char* kind, const char* wrong,
                        Allowed allowed) {
  return {[=](std::string& path) {
            std::error_code error;
            const fs::file_status status = fs::status(path, error);
            if (!fs::exists(status))
              fail("cannot read", path, std::string("there is no such ") + kind);
            if (!allowed(status)) fail("cannot read", path, wrong);
            return std::string{};
          },
          shown};
}

}  // namespace

CLI::Validator number_in(double lowest, double highest) {
  const std::string range =
      runtime::shortest_text(lowest) + " to " + runtime::shortest_text(highest);
  return number(range, " from " + range, [=](double v) { return v >= lowest && v <= highest; });
}

CLI::Validator positive_number() {
  return number("POSITIVE", " above 0", [](double v) { return v > 0.0; });
}

CLI::Validator number_from_zero() {
  return number("0 OR MORE", " of 0 or more", [](double v) { return v >= 0.0; });
}

CLI::Validator finite_number() {
  return number("", "", [](double) { return true; });
}

CLI::Validator whole_number() {
  return {[](std::string& text) {
            std::uint64_t value = 0;
            const char* end = text.data() + text.size();
            const auto [stopped, error] = std::from_chars(text.data(), end, value);
            return error == std::errc{} && stopped == end
                       ? std::string{}
                       : "'" + text + "' is no whole number from 0";
          },
          ""};
}

CLI::Validator existing_file() {
  return existing("FILE", "file", "it is a folder",
                  [](const fs::file_status& s) { return !fs::is_directory(s); });
}

CLI::Validator existing_folder() {
  return existing("FOLDER", "folder", "it is no folder",
                  [](const fs::file_status& s) { return fs::is_directory(s); });
}

CLI::Validator existing_path() {
  return existing("", "file or folder", "", [](const fs::file_status&) { return true; });
}

CLI::Validator writable_file() {
  return output_place().operation([](std::string& path) {
    std::error_code error;
    if (fs::is_directory(path, error)) fail("cannot write", path, "it is a folder; name a file");
    const fs::path folder = fs::path(path).parent_path();
    if (!folder.empty() && !fs::is_directory(folder, error)) {
      fail("cannot write", path, "there is no folder '" + folder.string() + "'; make it first");
    }
    return std::string{};
  });
}

}  // namespace maploop::tools
