#include "tools/evaluation/text_file.h"

#include <zlib.h>

#include <array>
#include <fstream>
#include <memory>
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

std::string read_text(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file))
    throw std::runtime_error("cannot read " + file.string() + ": it is a folder");
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> stream(gzopen(file.c_str(), "rb"), gzclose);
  if (!stream) throw std::runtime_error("cannot read " + file.string() + ": there is no such file");
  std::string text;
  std::array<char, 1 << 16> buffer{};
  int count = 0;
  while ((count = gzread(stream.get(), buffer.data(), buffer.size())) > 0)
    text.append(buffer.data(), static_cast<std::size_t>(count));
  int error = Z_OK;
  gzerror(stream.get(), &error);
  if (count < 0 || error != Z_OK)  // a cut file ends with Z_BUF_ERROR
    throw std::runtime_error(file.string() + " is damaged or cut: get it once more");
  return text;
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  const bool written =
      file.extension() == ".gz" ? write_compressed(file, text) : write_plain(file, text);
  if (!written) {
    throw std::runtime_error("cannot write " + file.string() +
                             ": does its folder exist, and has the disk room?");
  }
}

}  // namespace maploop::evaluation
