#include "sensors/bag/file_bytes.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "msgs/input_file.h"

namespace maploop::sensors::bag {

FileBytes::FileBytes(const std::filesystem::path& file)
    : file_(open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (file_ < 0) throw FileError(file, std::string("cannot be opened: ") + std::strerror(errno));
  const off_t size = lseek(file_, 0, SEEK_END);
  size_ = size < 0 ? 0 : static_cast<std::uint64_t>(size);
}

FileBytes::~FileBytes() {
  close(file_);
}

Bytes FileBytes::at(std::uint64_t offset, std::size_t count) {
  constexpr std::size_t read_ahead = std::size_t{64} * 1024;
  if (offset >= size_) return {};
  const std::uint64_t left = size_ - offset;
  count = std::min<std::uint64_t>(count, left);
  if (offset < begin_ || offset - begin_ > filled_ || filled_ - (offset - begin_) < count) {
    const auto wanted =
        static_cast<std::size_t>(std::min<std::uint64_t>(std::max(count, read_ahead), left));
    if (window_.size() < wanted) window_.resize(wanted);
    begin_ = offset;
    for (filled_ = 0; filled_ < wanted;) {
      const ssize_t got = pread(file_, window_.data() + filled_, wanted - filled_,
                                static_cast<off_t>(offset + filled_));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) break;
      filled_ += static_cast<std::size_t>(got);
    }
  }
  const auto from = static_cast<std::size_t>(offset - begin_);
  return Bytes(window_).subspan(from, std::min(count, filled_ - from));
}

}  // namespace maploop::sensors::bag
