#include "msgs/lcm/log/log_input.h"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace maploop::lcm_log {
namespace {

constexpr std::size_t kReadBytes = std::size_t{256} * 1024;

}  // namespace

struct LogInput::Stream {
  explicit Stream(gzFile opened) : file(opened) {}
  ~Stream() { gzclose_r(file); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  gzFile file;
};

LogInput::LogInput(const std::filesystem::path& file) : window_(2 * kReadBytes) {
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error("cannot read the log '" + file.string() + "': " + why);
  };
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (std::filesystem::is_directory(status)) refuse("it is a folder");
  const gzFile opened = gzopen(file.c_str(), "rb");
  if (opened == nullptr) refuse(std::strerror(errno));
  stream_ = std::make_unique<Stream>(opened);
  gzbuffer(opened, kReadBytes);
  if (std::filesystem::is_regular_file(status)) {
    file_size_ = std::filesystem::file_size(file, error);
    if (error) file_size_ = 0;
  }
}

LogInput::~LogInput() = default;
LogInput::LogInput(LogInput&&) noexcept = default;
LogInput& LogInput::operator=(LogInput&&) noexcept = default;

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
    if (window_.size() - end_ < kReadBytes && begin_ > window_.size() / 4) {
      std::copy(window_.begin() + static_cast<std::ptrdiff_t>(begin_),
                window_.begin() + static_cast<std::ptrdiff_t>(end_), window_.begin());
      end_ -= begin_;
      begin_ = 0;
    } else if (window_.size() - end_ < kReadBytes) {
      window_.resize(2 * window_.size());
    }
    const int got =
        gzread(stream_->file, window_.data() + end_, static_cast<unsigned>(window_.size() - end_));
    if (got > 0) {
      end_ += static_cast<std::size_t>(got);
    } else {
      at_end_ = true;
      note_failure();
    }
  }
}

void LogInput::note_failure() {
  int code = Z_OK;
  const char* text = gzerror(stream_->file, &code);
  if (code == Z_ERRNO) {
    failure_ = std::strerror(errno);
  } else if (code != Z_OK && code != Z_STREAM_END) {
    failure_ = std::string("the compressed file is damaged or cut (") + text + ")";
  }
}

std::uint64_t LogInput::file_position() const {
  const auto offset = gzoffset(stream_->file);
  return offset < 0 ? file_size_ : static_cast<std::uint64_t>(offset);
}

}  // namespace maploop::lcm_log
