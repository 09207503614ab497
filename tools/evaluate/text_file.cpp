#include "tools/evaluate/text_file.h"

#include <zlib.h>

#include <stdexcept>

#include "runtime/core/whole_file.h"

namespace maploop::evaluation {
namespace {

// Compresses as gzip, with zlib's default level.
std::string compressed(const std::string& text) {
  constexpr int gzip = 15 + 16;  // the largest window, with a gzip header
  z_stream stream{};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, gzip, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  std::string packed(deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

}  // namespace

void write_text(const std::filesystem::path& file, const std::string& text) {
  runtime::write_whole_file(file, file.extension() == ".gz" ? compressed(text) : text);
}

}  // namespace maploop::evaluation
