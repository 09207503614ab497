#include <liblzf/lzf.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <stdexcept>

#include "sensors/cloud/cloud_file.h"

namespace maploop::sensors {
namespace {

std::string header(const CloudTable& cloud, bool ply, CloudEncoding encoding) {
  const std::string points = std::to_string(cloud.values.size() / cloud.fields.size());
  if (ply) {
    std::string text =
        encoding == CloudEncoding::ascii ? "ply\nformat ascii" : "ply\nformat binary_little_endian";
    text += " 1.0\nelement vertex " + points + '\n';
    for (const std::string& field : cloud.fields)
      text +=
          "property float " + (field.starts_with("normal_") ? "n" + field.substr(7) : field) + '\n';
    return text + "end_header\n";
  }
  std::string fields, sizes, types, counts;
  for (const std::string& field : cloud.fields) {
    fields += ' ' + field;
    sizes += " 4";
    types += " F";
    counts += " 1";
  }
  constexpr std::array<const char*, 3> names{"ascii", "binary", "binary_compressed"};
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS" + fields + "\nSIZE" +
         sizes + "\nTYPE" + types + "\nCOUNT" + counts + "\nWIDTH " + points +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " +
         names[static_cast<std::size_t>(encoding)] + '\n';
}

std::string_view bytes_of(const std::vector<float>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

// The shortest digits that are read back as the same number.
std::string text_rows(const CloudTable& cloud) {
  std::string text;
  std::array<char, 32> digits;
  for (std::size_t i = 0; i < cloud.values.size(); ++i) {
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), cloud.values[i]);
    text.append(digits.data(), end.ptr) += (i + 1) % cloud.fields.size() == 0 ? '\n' : ' ';
  }
  return text;
}

// Field by field, behind the sizes after and before the compression.
std::string compressed_fields(const CloudTable& cloud) {
  std::vector<float> by_field;
  by_field.reserve(cloud.values.size());
  for (std::size_t k = 0; k < cloud.fields.size(); ++k)
    for (std::size_t i = k; i < cloud.values.size(); i += cloud.fields.size())
      by_field.push_back(cloud.values[i]);
  const std::string_view plain = bytes_of(by_field);
  const std::size_t most = plain.size() + plain.size() / 16 + 64;  // where nothing repeats
  if (most > UINT32_MAX) throw std::runtime_error("a compressed cloud has at most 4 GB");
  std::string text(8 + most, '\0');
  const std::array<std::uint32_t, 2> sizes{
      lzf_compress(plain.data(), static_cast<unsigned>(plain.size()), text.data() + 8,
                   static_cast<unsigned>(most)),
      static_cast<std::uint32_t>(plain.size())};
  text.replace(0, 8, reinterpret_cast<const char*>(sizes.data()), 8);
  text.resize(8 + sizes[0]);
  return text;
}

}  // namespace

void check_cloud_name(const std::filesystem::path& file, CloudEncoding encoding) {
  if (file.extension() != ".ply" && file.extension() != ".pcd")
    throw std::runtime_error("'" + file.string() + "': a cloud is written as .ply or .pcd");
  if (file.extension() == ".ply" && encoding == CloudEncoding::compressed)
    throw std::runtime_error("'" + file.string() + "': a .ply cannot be compressed; name a .pcd");
}

std::string encode_cloud(const CloudTable& cloud, const std::filesystem::path& file,
                         CloudEncoding encoding) {
  check_cloud_name(file, encoding);
  std::string text = header(cloud, file.extension() == ".ply", encoding);
  switch (encoding) {
    case CloudEncoding::ascii:
      return text + text_rows(cloud);
    case CloudEncoding::binary:
      return text.append(bytes_of(cloud.values));
    default:
      return text + compressed_fields(cloud);
  }
}

}  // namespace maploop::sensors
