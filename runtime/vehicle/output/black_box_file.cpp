#include "runtime/vehicle/output/black_box_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <iostream>
#include <stdexcept>

#include "msgs/xxh3.h"

namespace maploop::vehicle::black_box {
namespace {

static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(Head) == 48 && sizeof(BlockHead) == 32);

constexpr std::uint64_t fewest_blocks = 16;
constexpr mode_t for_its_owner = 0600;

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& why) {
  throw std::runtime_error(fmt::format("the black box '{}': {}", path.string(), why));
}

off_t offset_of(std::uint64_t place) {
  return static_cast<off_t>((place + 1) * block_bytes);
}

bool is_box(const Head& head) {
  return head.magic == magic && head.version == version && head.blocks > 0;
}

bool pread_all(int descriptor, void* to, std::size_t size, off_t at) {
  return pread(descriptor, to, size, at) == static_cast<ssize_t>(size);
}

bool pwrite_all(int descriptor, const void* from, std::size_t size, off_t at) {
  return pwrite(descriptor, from, size, at) == static_cast<ssize_t>(size);
}

// Moves a box that somebody may want to read out of the way.
void keep_evidence(const std::filesystem::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  Head head;
  const bool box = pread_all(descriptor, &head, sizeof head, 0) && is_box(head);
  const bool writing = flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(descriptor);
  if (writing) fail(path, "another run is writing it; name another file with --black-box");
  if (!box) {
    std::error_code error;
    const bool empty = std::filesystem::file_size(path, error) == 0;
    if (!empty && std::filesystem::is_regular_file(path, error))
      fail(path, "is a file of another kind, and is not replaced; name another file");
    return;
  }
  if (head.closed != 0 && head.frozen == 0) return;
  const std::filesystem::path kept = path.string() + ".kept";
  const char* const why = head.frozen != 0 ? "is frozen" : "is of a run that did not end by itself";
  if (std::filesystem::exists(kept)) {
    std::cerr << fmt::format(
        "maploop: the black box '{}' {}, and is replaced, because '{}' is there already\n",
        path.string(), why, kept.string());
    return;
  }
  std::filesystem::rename(path, kept);
  std::cerr << fmt::format("maploop: the black box '{}' {}: it is now '{}'\n", path.string(), why,
                           kept.string());
}

}  // namespace

std::uint64_t hash_of(std::span<const std::uint8_t> block) {
  return XXH3_64bits(block.data() + sizeof(std::uint64_t), block.size() - sizeof(std::uint64_t));
}

File::File(const std::filesystem::path& path, For what)
    : path_(path),
      descriptor_(open(path.c_str(), (what == For::asking ? O_RDWR : O_RDONLY) | O_CLOEXEC)) {
  if (descriptor_ < 0) fail(path_, fmt::format("cannot be opened: {}", std::strerror(errno)));
  if (!pread_all(descriptor_, &head_, sizeof head_, 0) || !is_box(head_)) {
    close(descriptor_);
    fail(path_, "is no black box, or of another version of maploop");
  }
}

File::File(const std::filesystem::path& path, std::uint64_t bytes) : path_(path) {
  keep_evidence(path);
  descriptor_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, for_its_owner);
  if (descriptor_ < 0) {
    fail(path_,
         fmt::format("cannot be written: {}; check that its folder exists and may be written",
                     std::strerror(errno)));
  }
  flock(descriptor_, LOCK_EX | LOCK_NB);
  head_.magic = magic;
  head_.version = version;
  head_.run =
      static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
  head_.blocks = std::max(fewest_blocks, bytes / block_bytes);
  const off_t size = offset_of(head_.blocks);
  if (ftruncate(descriptor_, size) != 0) errno = EFBIG;
  if (const int error = posix_fallocate(descriptor_, 0, size); error != 0) {
    close(descriptor_);
    fail(path_, fmt::format("there is no room for its {} MB: {}; choose a smaller "
                            "--black-box-size, or another disk",
                            size / 1'000'000, std::strerror(error)));
  }
  if (!pwrite_all(descriptor_, &head_, sizeof head_, 0))
    fail(path_, fmt::format("cannot be written: {}", std::strerror(errno)));
}

File::~File() {
  close(descriptor_);
}

Head File::read_head() const {
  Head head;
  if (!pread_all(descriptor_, &head, sizeof head, 0) || !is_box(head))
    fail(path_, fmt::format("its head cannot be read: {}", std::strerror(errno)));
  return head;
}

void File::set(std::uint32_t Head::*field) {
  head_.*field = 1;
  const auto at =
      reinterpret_cast<const char*>(&(head_.*field)) - reinterpret_cast<const char*>(&head_);
  if (!pwrite_all(descriptor_, &(head_.*field), sizeof(std::uint32_t), at))
    fail(path_, fmt::format("its head cannot be written: {}", std::strerror(errno)));
}

bool File::write_block(std::uint64_t place, std::span<const std::uint8_t> block) {
  return pwrite_all(descriptor_, block.data(), block.size(), offset_of(place));
}

void File::sync() {
  fdatasync(descriptor_);
}

bool File::read_block(std::uint64_t place, std::vector<std::uint8_t>& block) const {
  block.resize(block_bytes);
  if (!pread_all(descriptor_, block.data(), block.size(), offset_of(place))) return false;
  BlockHead head;
  std::memcpy(&head, block.data(), sizeof head);
  if (head.run != head_.run || head.used > room || head.first_event > head.used) return false;
  block.resize(sizeof head + head.used);
  return hash_of(block) == head.hash;
}

}  // namespace maploop::vehicle::black_box
