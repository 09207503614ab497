// A file that is there as a whole, or not at all.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string_view>

namespace maploop::runtime {

// Written from its begin to its end through a buffer of fixed size, under the name FILE.part. Only
// keep() gives it its own name, when all of it is on the disk: whatever was there before stays
// whole until then, also where the disk is full or the power fails. What is no regular file (a
// device, a pipe) is written as it is.
//
// Every function throws std::runtime_error that names the file, the system's reason and what to do.
// One thread at a time.
class WholeFile {
 public:
  explicit WholeFile(const std::filesystem::path& file);
  ~WholeFile();  // without keep(): as if it had never been begun
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void write(std::string_view bytes);
  void keep();

 private:
  void flush();
  [[noreturn]] void fail(int error) const;

  static constexpr std::size_t kBytes = std::size_t{64} * 1024;

  std::filesystem::path file_;
  std::filesystem::path written_;  // file_ itself where that is no regular file
  int descriptor_ = -1;
  std::size_t used_ = 0;
  std::unique_ptr<std::array<char, kBytes>> buffer_;
};

// All of it at once.
void write_whole_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace maploop::runtime
