#include "sensors/bag/compression.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <new>
#include <stdexcept>

#include "msgs/input_limits.h"

namespace maploop::sensors::bag {
namespace {

// Says what one call of a decoder did.
struct Step {
  std::size_t consumed = 0, produced = 0;
  bool ended = false;        // the frame; another one may follow
  std::string_view failure;  // valid until the next step
};

using Room = std::span<std::uint8_t>;

struct Zstd {
  std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> context{ZSTD_createDCtx(), ZSTD_freeDCtx};

  Step operator()(Bytes in, Room out) const {
    if (!context) throw std::bad_alloc();
    ZSTD_inBuffer from{in.data(), in.size(), 0};
    ZSTD_outBuffer to{out.data(), out.size(), 0};
    const std::size_t result = ZSTD_decompressStream(context.get(), &to, &from);
    const char* const failure = ZSTD_isError(result) ? ZSTD_getErrorName(result) : "";
    return {from.pos, to.pos, result == 0, failure};
  }
};

struct Lz4 {
  static LZ4F_dctx* create() {
    LZ4F_dctx* context = nullptr;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION))) return nullptr;
    return context;
  }
  std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> context{
      create(), LZ4F_freeDecompressionContext};

  Step operator()(Bytes in, Room out) const {
    if (!context) throw std::bad_alloc();
    std::size_t consumed = in.size(), produced = out.size();
    const std::size_t result =
        LZ4F_decompress(context.get(), out.data(), &produced, in.data(), &consumed, nullptr);
    if (LZ4F_isError(result)) return {0, 0, false, LZ4F_getErrorName(result)};
    return {consumed, produced, result == 0, {}};
  }
};

struct Bzip2 {
  bz_stream stream{};
  bool started = false;

  Bzip2() = default;
  Bzip2(const Bzip2&) = delete;
  Bzip2& operator=(const Bzip2&) = delete;
  ~Bzip2() { end(); }
  void end() {
    if (started) BZ2_bzDecompressEnd(&stream);
    started = false;
  }

  Step operator()(Bytes in, Room out) {
    constexpr std::size_t most = 1U << 30U;
    if (!started && BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw std::bad_alloc();
    started = true;
    const auto in_size = static_cast<unsigned>(std::min(in.size(), most));
    const auto out_size = static_cast<unsigned>(std::min(out.size(), most));
    stream.next_in = reinterpret_cast<char*>(const_cast<std::uint8_t*>(in.data()));
    stream.avail_in = in_size;
    stream.next_out = reinterpret_cast<char*>(out.data());
    stream.avail_out = out_size;
    const int result = BZ2_bzDecompress(&stream);
    if (result == BZ_MEM_ERROR) throw std::bad_alloc();
    const Step step{in_size - stream.avail_in, out_size - stream.avail_out, result == BZ_STREAM_END,
                    result < BZ_OK ? std::string_view("not the data of bzip2") : ""};
    if (step.ended) end();
    return step;
  }
};

std::string bytes_text(std::uint64_t count) {
  return std::to_string(count) + " bytes";
}

template <class Decoder>
Inflated inflate_by(Decoder decode, Bytes packed, InflatedSize size,
                    std::vector<std::uint8_t>& buffer) {
  constexpr std::size_t least_room = std::size_t{64} * 1024, usual_ratio = 8;
  const std::size_t limit = size.exact ? size.stated : input_limits::chunk;
  // One byte more than the limit shows that there is more than that.
  const auto grow = [&](std::size_t to) {
    if (const std::size_t room = std::min(to, limit + 1); buffer.size() < room) buffer.resize(room);
  };
  grow(std::max(least_room, usual_ratio * packed.size()));
  Bytes in = packed;
  std::size_t filled = 0;
  bool ended = false;
  for (;;) {
    if (filled == std::min(buffer.size(), limit + 1)) grow(2 * filled);
    const Step step =
        decode(in, Room(buffer).first(std::min(buffer.size(), limit + 1)).subspan(filled));
    in = in.subspan(step.consumed);
    filled += step.produced;
    const Bytes bytes = Bytes(buffer).first(std::min(filled, limit));
    if (!step.failure.empty())
      return {bytes, "its compressed data are damaged (" + std::string(step.failure) + ")"};
    if (filled > limit)
      return {bytes, "its compressed data inflate to more than " + bytes_text(limit)};
    ended = step.ended;
    // What a decoder still holds comes without further input; it then fills the room it has.
    const bool more = !in.empty() || (step.produced > 0 && !ended);
    if (!more || (step.consumed == 0 && step.produced == 0)) break;
  }
  const Bytes bytes = Bytes(buffer).first(filled);
  // A frame without its end mark is whole if it has all bytes.
  if (filled == size.stated && (size.exact || filled > 0)) return {bytes, ""};
  if (ended && !size.exact) return {bytes, ""};
  return {bytes, "its compressed data are cut: they inflate to only " + bytes_text(filled)};
}

}  // namespace

bool is_zstd(Bytes bytes) {
  return bytes.size() >= zstd_magic.size() &&
         std::equal(zstd_magic.begin(), zstd_magic.end(), bytes.begin());
}

Inflated inflate(std::string_view compression, Bytes packed, InflatedSize size,
                 std::vector<std::uint8_t>& buffer) {
  if (size.exact && size.stated > input_limits::chunk) {
    return {{},
            "its " + bytes_text(size.stated) + " are more than the " +
                bytes_text(input_limits::chunk) + " that are expected"};
  }
  if (compression.empty() || compression == "none") {
    if (!size.exact || packed.size() == size.stated) return {packed, ""};
    return {packed,
            "its " + bytes_text(packed.size()) + " are not the stated " + bytes_text(size.stated)};
  }
  if (compression == "zstd") return inflate_by(Zstd(), packed, size, buffer);
  if (compression == "lz4") return inflate_by(Lz4(), packed, size, buffer);
  if (compression == "bz2") {
    Bzip2 decoder;
    return inflate_by(std::ref(decoder), packed, size, buffer);
  }
  return {{}, "its compression is not none, bz2, lz4 or zstd"};
}

// Nothing but a lack of memory can happen with the room that each is given.
std::string pack(std::string_view compression, std::string_view plain) {
  if (compression == "none") return std::string(plain);
  std::string packed;
  std::size_t size = 0;
  bool failed = false;
  if (compression == "zstd") {
    packed.resize(ZSTD_compressBound(plain.size()));
    size = ZSTD_compress(packed.data(), packed.size(), plain.data(), plain.size(),
                         ZSTD_CLEVEL_DEFAULT);
    failed = ZSTD_isError(size) != 0U;
  } else if (compression == "lz4") {
    LZ4F_preferences_t preferences{};  // the form of frames that ROS reads
    preferences.frameInfo.blockMode = LZ4F_blockIndependent;
    preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
    packed.resize(LZ4F_compressFrameBound(plain.size(), &preferences));
    size =
        LZ4F_compressFrame(packed.data(), packed.size(), plain.data(), plain.size(), &preferences);
    failed = LZ4F_isError(size) != 0U;
  } else if (compression == "bz2") {
    constexpr int block = 9, quiet = 0, usual_effort = 0;
    auto bytes = static_cast<unsigned>(plain.size() + plain.size() / 100 + 600);
    packed.resize(bytes);
    failed = BZ2_bzBuffToBuffCompress(packed.data(), &bytes, const_cast<char*>(plain.data()),
                                      static_cast<unsigned>(plain.size()), block, quiet,
                                      usual_effort) != BZ_OK;
    size = bytes;
  } else {
    throw std::invalid_argument("'" + std::string(compression) +
                                "' is not a compression; use none, lz4, bz2 or zstd");
  }
  if (failed) throw std::bad_alloc();
  packed.resize(size);
  return packed;
}

std::uint32_t crc_of(Bytes bytes, std::uint32_t before) {
  return static_cast<std::uint32_t>(crc32_z(before, bytes.data(), bytes.size()));
}

}  // namespace maploop::sensors::bag
