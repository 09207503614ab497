#include "mapmatch/network_file.h"

#include <array>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "mapmatch/network_builder.h"
#include "msgs/archive.h"

namespace maploop::mapmatch {
namespace {

constexpr std::string_view section = "road network";
constexpr std::uint32_t version = 1;
constexpr std::uintmax_t max_size = std::uintmax_t{4} << 30U;  // bytes

Bytes read_file(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file))
    throw std::runtime_error("there is no such regular file");
  const std::uintmax_t size = std::filesystem::file_size(file);
  if (size > max_size) throw std::runtime_error("it is larger than 4 GB");
  Bytes bytes(size);
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!in) throw std::runtime_error("it cannot be read to its end");
  return bytes;
}

// Whether a file begins as an archive does.
bool is_archive(const std::filesystem::path& file) {
  std::array<char, 8> begin{};
  std::ifstream in(file, std::ios::binary);
  in.read(begin.data(), begin.size());
  return in && std::string_view(begin.data(), begin.size()) == "maploop\n";
}

}  // namespace

void save_network(const std::filesystem::path& file, const NetworkData& network) {
  ArchiveWriter writer;
  writer.section(section, version);
  writer(network);
  const Bytes sealed = seal(writer.content());
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(sealed.data()),
            static_cast<std::streamsize>(sealed.size()));
  out.flush();
  if (!out)
    throw std::runtime_error("cannot write " + file.string() +
                             ": does its folder exist, and has the disk room?");
}

NetworkData load_network(const std::filesystem::path& file) {
  try {
    const Bytes bytes = read_file(file);
    ArchiveReader reader(unseal(bytes));
    reader.section(section, version);
    NetworkData network;
    reader(network);
    reader.finish();
    return network;
  } catch (const std::exception& e) {
    throw std::runtime_error("cannot load the road network " + file.string() + ": " + e.what());
  }
}

NetworkData open_network(const std::filesystem::path& file, const OsmOptions& options) {
  return is_archive(file) ? load_network(file) : build_network(read_osm(file, options));
}

}  // namespace maploop::mapmatch
