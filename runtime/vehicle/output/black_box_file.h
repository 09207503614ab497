// The file of a black box: a ring of blocks of fixed size.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace maploop::vehicle::black_box {

// The file begins with one block that holds a Head; the others hold a BlockHead and then bytes of
// an LCM log, whose events go on from one block to the next. Numbers are little-endian.
inline constexpr std::size_t block_bytes = std::size_t{64} << 10;
inline constexpr std::array<char, 16> magic{'m', 'a', 'p', 'l', 'o', 'o', 'p', ' ',
                                            'b', 'l', 'a', 'c', 'k', 'b', 'o', 'x'};
inline constexpr std::uint32_t version = 1;

struct Head {
  std::array<char, 16> magic{};
  std::uint32_t version = 0;
  std::uint32_t freeze_asked = 0;  // 1: another process has asked for it
  std::uint32_t frozen = 0;        // 1: nothing more is written
  std::uint32_t closed = 0;        // 1: the run has ended by itself
  std::uint64_t run = 0;           // blocks of other runs are old
  std::uint64_t blocks = 0;        // besides this one
};

struct BlockHead {
  std::uint64_t hash = 0;  // XXH3 of the rest of the head and of the bytes used
  std::uint64_t run = 0;
  std::uint64_t number = 0;       // counts from 0; at number % blocks in the ring
  std::uint32_t used = 0;         // bytes after this head
  std::uint32_t first_event = 0;  // where an event begins, after this head; `used`: nowhere
};

inline constexpr std::size_t room = block_bytes - sizeof(BlockHead);

// Returns the hash of a block: its head, and the bytes used after it.
std::uint64_t hash_of(std::span<const std::uint8_t> block);

// One thread at a time. Every function but the destructor throws std::runtime_error that names the
// file, and what to do.
class File {
 public:
  enum class For { reading, asking };  // asking may write, besides the run that does

  // Opens the box of a run, which may go on.
  File(const std::filesystem::path& path, For what);
  // Makes a box with room for this many bytes, all of which are allocated now, so that a full disk
  // is found before the drive. A box that is there is replaced; but if it is frozen, or its run did
  // not end by itself, it is evidence and becomes PATH.kept, unless there is one already.
  File(const std::filesystem::path& path, std::uint64_t bytes);
  ~File();
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  const Head& head() const { return head_; }
  Head read_head() const;                // as it is now
  void set(std::uint32_t Head::*field);  // to 1; the others may be somebody else's

  // Neither throws. A block is written whole or, if power fails, recognized as damaged.
  bool write_block(std::uint64_t place, std::span<const std::uint8_t> block);
  void sync();

  // Returns the block at a place of the ring; false if it is damaged, of an older run, or empty.
  bool read_block(std::uint64_t place, std::vector<std::uint8_t>& block) const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  Head head_;
};

}  // namespace maploop::vehicle::black_box
