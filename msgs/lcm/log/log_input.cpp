#include "msgs/lcm/log/log_input.h"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace maploop::lcm_log {
namespace {

constexpr std::size_t read_size = std::size_t{256} * 1024;

}  // namespace

LogInput::LogInput(const std::filesystem::path& file)
    : stream_(gzopen(file.c_str(), "rb"), gzclose_r), window_(2 * read_size) {
  const bool folder = std::filesystem::is_directory(file);
  if (!stream_ || folder) {
    throw std::runtime_error("cannot read the log '" + file.string() +
                             "': " + (folder ? "it is a folder" : std::strerror(errno)));
  }
  gzbuffer(stream_.get(), read_size);
  std::error_code unknown;
  if (std::filesystem::is_regular_file(file))
    file_size_ = std::filesystem::file_size(file, unknown);
  if (unknown) file_size_ = 0;
}

std::span<const std::uint8_t> LogInput::peek(std::size_t size) {
  if (end_ - begin_ < size && !at_end_) read_more(size);
  return std::span(window_).subspan(begin_, end_ - begin_);
}

void LogInput::skip(std::size_t count) {
  begin_ += count;
  position_ += count;
}

void LogInput::read_more(std::size_t size) {
  while (end_ - begin_ < size && !at_end_) {
    // The window grows as bytes arrive, so a hostile size in a small file allocates nothing. Bytes
    // are moved only if at least a third as many were skipped, so that reading stays linear.
    if (window_.size() - end_ < read_size && begin_ > window_.size() / 4) {
      std::copy(window_.begin() + static_cast<std::ptrdiff_t>(begin_),
                window_.begin() + static_cast<std::ptrdiff_t>(end_), window_.begin());
      end_ -= begin_;
      begin_ = 0;
    } else if (window_.size() - end_ < read_size) {
      window_.resize(2 * window_.size());
    }
    const int got =
        gzread(stream_.get(), window_.data() + end_, static_cast<unsigned>(window_.size() - end_));
    at_end_ = got <= 0;
    if (at_end_) return note_failure();
    end_ += static_cast<std::size_t>(got);
  }
}

void LogInput::note_failure() {
  int code = Z_OK;
  const char* text = gzerror(stream_.get(), &code);
  if (code == Z_ERRNO) {
    failure_ = std::strerror(errno);
  } else if (code != Z_OK && code != Z_STREAM_END) {
    failure_ = std::string("the compressed file is damaged or cut (") + text + ")";
  }
}

std::uint64_t LogInput::file_position() const {
  const auto offset = gzoffset(stream_.get());
  return offset < 0 ? file_size_ : static_cast<std::uint64_t>(offset);
}

}  // namespace maploop::lcm_log
