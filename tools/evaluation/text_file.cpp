#include "tools/evaluation/text_file.h"

#include <zlib.h>

#include <fstream>
#include <stdexcept>

namespace maploop::evaluation {
namespace {

bool write_plain(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text << std::flush;
  return static_cast<bool>(out);
}

bool write_compressed(const std::filesystem::path& file, const std::string& text) {
  const gzFile out = gzopen(file.c_str(), "wb");
  if (!out) return false;
  const bool written = gzfwrite(text.data(), 1, text.size(), out) == text.size();
  return gzclose(out) == Z_OK && written;
}

}  // namespace

void write_text(const std::filesystem::path& file, const std::string& text) {
  const bool written =
      file.extension() == ".gz" ? write_compressed(file, text) : write_plain(file, text);
  if (!written) {
    throw std::runtime_error("cannot write " + file.string() +
                             ": does its folder exist, and has the disk room?");
  }
}

}  // namespace maploop::evaluation
