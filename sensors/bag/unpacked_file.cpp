#include "sensors/bag/unpacked_file.h"

#include <unistd.h>
#include <zlib.h>
#include <zstd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <vector>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "sensors/bag/compression.h"

namespace maploop::sensors::bag {
namespace {

// A bag or MCAP file up to the profile of our own recordings; longer than other formats' magic.
constexpr std::size_t head_bytes = 64;
constexpr std::string_view gzip_magic = "\x1f\x8b";

Bytes as_bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// Is the temporary file that is being written.
class TemporaryOutput {
 public:
  explicit TemporaryOutput(const std::filesystem::path& packed) : packed_(packed) {
    std::string name = (std::filesystem::temp_directory_path() / "maploop_XXXXXX").string();
    file_ = mkstemp(name.data());
    if (file_ < 0) fail(std::string("no temporary file for its content: ") + std::strerror(errno));
    path_ = name;
  }
  ~TemporaryOutput() {
    close(file_);
    if (!kept_) unlink(path_.c_str());
  }
  TemporaryOutput(const TemporaryOutput&) = delete;
  TemporaryOutput& operator=(const TemporaryOutput&) = delete;

  void write(const void* data, std::size_t size) {
    written_ += size;
    if (written_ > input_limits::unpacked_bag) {
      fail("too large: more than " + std::to_string(input_limits::unpacked_bag) +
           " bytes when decompressed");
    }
    for (const char* at = static_cast<const char*>(data); size > 0;) {
      const ssize_t done = ::write(file_, at, size);
      if (done < 0 && errno == EINTR) continue;
      if (done <= 0) {
        fail("cannot be decompressed into " + path_.parent_path().string() + ": " +
             std::strerror(errno) + "; set TMPDIR to a folder with more space");
      }
      at += done;
      size -= static_cast<std::size_t>(done);
    }
  }
  std::filesystem::path keep() {
    kept_ = true;
    return path_;
  }
  [[noreturn]] void damaged() const { fail("its compressed data are damaged or cut"); }

 private:
  [[noreturn]] void fail(const std::string& reason) const { throw FileError(packed_, reason); }

  std::filesystem::path packed_, path_;
  int file_ = -1;
  bool kept_ = false;
  std::uint64_t written_ = 0;
};

void unpack_zstd(const std::filesystem::path& file, TemporaryOutput& out) {
  std::ifstream stream(file, std::ios::binary);
  const std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> context(ZSTD_createDCtx(),
                                                                        ZSTD_freeDCtx);
  if (!context) throw FileError(file, "does not fit into memory");
  std::vector<char> packed(ZSTD_DStreamInSize()), plain(ZSTD_DStreamOutSize());
  std::size_t state = 0;  // not 0 inside a frame
  while (stream.read(packed.data(), static_cast<std::streamsize>(packed.size())),
         stream.gcount() > 0) {
    ZSTD_inBuffer from{packed.data(), static_cast<std::size_t>(stream.gcount()), 0};
    bool full = false;  // then the decoder may hold more
    while (from.pos < from.size || full) {
      ZSTD_outBuffer to{plain.data(), plain.size(), 0};
      state = ZSTD_decompressStream(context.get(), &to, &from);
      if (ZSTD_isError(state)) out.damaged();
      out.write(plain.data(), to.pos);
      full = to.pos == to.size && state != 0;
    }
  }
  if (state != 0) out.damaged();
}

void unpack_gzip(const std::filesystem::path& file, TemporaryOutput& out) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> stream(gzopen(file.c_str(), "rb"), gzclose);
  if (!stream) throw FileError(file, std::string("cannot be opened: ") + std::strerror(errno));
  std::vector<char> plain(std::size_t{256} * 1024);
  int count = 0;
  while ((count = gzread(stream.get(), plain.data(), static_cast<unsigned>(plain.size()))) > 0)
    out.write(plain.data(), static_cast<std::size_t>(count));
  int state = Z_OK;
  gzerror(stream.get(), &state);
  if (count < 0 || state != Z_OK) out.damaged();
}

}  // namespace

std::string unpacked_head(const std::filesystem::path& file) {
  constexpr std::size_t packed_bytes = std::size_t{64} * 1024;  // enough for a few of the others
  std::string head = read_head(file, head_bytes);
  if (is_zstd(as_bytes(head))) {
    head = read_head(file, packed_bytes);
    std::vector<std::uint8_t> buffer;
    // It is not of that size: what has been inflated up to there is enough.
    head = as_text(inflate("zstd", as_bytes(head), {packed_bytes, true}, buffer).bytes);
  }
  head.resize(std::min(head.size(), head_bytes));
  return head;
}

UnpackedFile::UnpackedFile(const std::filesystem::path& file) : path_(file) {
  read_head(file, 0);  // refuses what is not a regular file
  std::string magic(zstd_magic.size(), '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw FileError(file, "cannot be opened: no permission to read it?");
  stream.read(magic.data(), static_cast<std::streamsize>(magic.size()));
  const bool zstd = is_zstd(as_bytes(magic));
  if (!zstd && !magic.starts_with(gzip_magic)) return;
  TemporaryOutput out(file);
  zstd ? unpack_zstd(file, out) : unpack_gzip(file, out);
  path_ = out.keep();
  temporary_ = true;
}

UnpackedFile::~UnpackedFile() {
  if (temporary_) unlink(path_.c_str());
}

}  // namespace maploop::sensors::bag
