#include "msgs/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

namespace maploop {
namespace {

bool is_replaced(const std::filesystem::path& file) {
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  return !std::filesystem::exists(status) || std::filesystem::is_regular_file(status);
}

// A link stays a link: its target is replaced, or made.
std::filesystem::path behind_links(std::filesystem::path file) {
  constexpr int most = 40;  // the system's own limit
  std::error_code error;
  for (int i = 0; i < most && std::filesystem::is_symlink(file, error); ++i) {
    file = file.parent_path() / std::filesystem::read_symlink(file);
  }
  return file;
}

// Writes the new name to the disk too; errors are ignored, as some file systems cannot do this.
void sync_folder(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  ::close(descriptor);
}

// The file in progress is no link: somebody else could have put one there, to have another file
// overwritten.
int flags_of(const std::filesystem::path& written, const std::filesystem::path& file) {
  return O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | (written != file ? O_NOFOLLOW : 0);
}

std::string_view characters(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

WholeFile::WholeFile(const std::filesystem::path& file)
    : file_(is_replaced(file) ? behind_links(file) : file),
      written_(file_.string() + (is_replaced(file_) ? ".part" : "")),
      descriptor_(open(written_.c_str(), flags_of(written_, file_), 0666)),
      buffer_(std::make_unique<std::array<char, chunk_bytes>>()) {
  if (descriptor_ < 0) fail(errno);
}

WholeFile::~WholeFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  if (written_ != file_) unlink(written_.c_str());
}

void WholeFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    if (used_ == buffer_->size()) flush();
    const std::size_t part = std::min(bytes.size(), buffer_->size() - used_);
    std::copy_n(bytes.data(), part, buffer_->data() + used_);
    used_ += part;
    bytes.remove_prefix(part);
  }
}

void WholeFile::write(std::span<const std::uint8_t> bytes) {
  write(characters(bytes));
}

void WholeFile::flush() {
  for (std::size_t done = 0; done < used_;) {
    const ssize_t written = ::write(descriptor_, buffer_->data() + done, used_ - done);
    if (written >= 0) {
      done += static_cast<std::size_t>(written);
    } else if (errno != EINTR) {
      fail(errno);
    }
  }
  used_ = 0;
}

void WholeFile::replace_head(std::span<const std::uint8_t> bytes) {
  flush();
  for (off_t at = 0; !bytes.empty();) {
    const ssize_t written = pwrite(descriptor_, bytes.data(), bytes.size(), at);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(errno);
    at += written;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void WholeFile::replace_head(std::string_view bytes) {
  replace_head({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

void WholeFile::keep() {
  flush();
  const bool replaces = written_ != file_;
  if (replaces && fsync(descriptor_) != 0) fail(errno);
  if (replaces && rename(written_.c_str(), file_.c_str()) != 0) fail(errno);
  if (::close(std::exchange(descriptor_, -1)) != 0) fail(errno);
  if (replaces) sync_folder(file_);
}

void WholeFile::fail(int error) const {
  throw std::runtime_error("cannot write '" + file_.string() + "': " + std::strerror(error) +
                           "; does its folder exist, may it be written, and has the disk room?");
}

void write_whole_file(const std::filesystem::path& file, std::string_view bytes) {
  WholeFile whole(file);
  whole.write(bytes);
  whole.keep();
}

void write_whole_file(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  write_whole_file(file, characters(bytes));
}

}  // namespace maploop
