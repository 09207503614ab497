#include "runtime/vehicle/output/recorded_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace maploop::vehicle {

RecordedFile::RecordedFile(const std::string& path)
    : descriptor_(open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) {
    throw std::runtime_error("cannot write the log '" + path + "': " + std::strerror(errno) +
                             "; check that its folder exists and may be written");
  }
  struct stat status {};
  if (fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) return;  // such as /dev/null
  // Two recordings into one file would be mixed. The lock lasts as long as the descriptor.
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(descriptor_);
    throw std::runtime_error("cannot write the log '" + path +
                             "': another run is recording to it; name another file (--record)");
  }
  if (ftruncate(descriptor_, 0) != 0) {
    close(descriptor_);
    throw std::runtime_error("cannot empty the log '" + path + "': " + std::strerror(errno));
  }
}

RecordedFile::~RecordedFile() {
  close(descriptor_);
}

std::size_t RecordedFile::append(std::span<const std::uint8_t> bytes,
                                 std::span<const std::size_t> ends) {
  const std::size_t written = put(bytes);
  if (written == bytes.size()) {
    size_ += static_cast<off_t>(written);
    return ends.size();
  }
  // The file is cut after its last whole part; a device cannot be cut.
  const auto cut = std::upper_bound(ends.begin(), ends.end(), written);
  if (cut != ends.begin()) size_ += static_cast<off_t>(*(cut - 1));
  if (ftruncate(descriptor_, size_) == 0) lseek(descriptor_, size_, SEEK_SET);
  return static_cast<std::size_t>(cut - ends.begin());
}

std::size_t RecordedFile::put(std::span<const std::uint8_t> bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t written = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) break;
    done += static_cast<std::size_t>(written);
  }
  return done;
}

void RecordedFile::sync() {
  fsync(descriptor_);
}

}  // namespace maploop::vehicle
