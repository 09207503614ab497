#include "runtime/core/trace_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace maploop::runtime {

TraceFile::TraceFile(const std::filesystem::path& path)
    : name_(path.string()),
      descriptor_(open(name_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)),
      buffer_(std::make_unique<std::array<char, kBytes>>()) {
  if (descriptor_ < 0) fail("cannot be opened", errno);
}

TraceFile::~TraceFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void TraceFile::write(std::string_view text) {
  while (!text.empty()) {
    if (used_ == buffer_->size()) flush();
    const std::size_t part = std::min(text.size(), buffer_->size() - used_);
    std::copy_n(text.data(), part, buffer_->data() + used_);
    used_ += part;
    text.remove_prefix(part);
  }
}

void TraceFile::flush() {
  for (std::size_t done = 0; done < used_;) {
    const ssize_t written = ::write(descriptor_, buffer_->data() + done, used_ - done);
    if (written >= 0) {
      done += static_cast<std::size_t>(written);
    } else if (errno != EINTR) {
      fail("cannot be written, and is cut short", errno);
    }
  }
  used_ = 0;
}

void TraceFile::close() {
  flush();
  if (::close(std::exchange(descriptor_, -1)) != 0) fail("cannot be written", errno);
}

void TraceFile::fail(const char* what, int error) const {
  throw std::runtime_error("trace: " + name_ + " " + what + " (" + std::strerror(error) +
                           "); name a file in a folder that exists, may be written and has room");
}

}  // namespace maploop::runtime
