// A file written from its begin to its end through a buffer of fixed size.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace maploop::runtime {

// Every function throws std::runtime_error that names the file, the system's reason and what to do.
class TraceFile {
 public:
  explicit TraceFile(const std::filesystem::path& path);
  ~TraceFile();
  TraceFile(const TraceFile&) = delete;
  TraceFile& operator=(const TraceFile&) = delete;

  void write(std::string_view text);

  // Must be called for the file to be whole.
  void close();

 private:
  void flush();
  [[noreturn]] void fail(const char* what, int error) const;

  static constexpr std::size_t kBytes = std::size_t{64} * 1024;

  std::string name_;
  int descriptor_ = -1;
  std::size_t used_ = 0;
  std::unique_ptr<std::array<char, kBytes>> buffer_;
};

}  // namespace maploop::runtime
