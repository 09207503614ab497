#include "sensors/image/jpeg.h"

#include <turbojpeg.h>

#include <cstddef>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "sensors/image/image_size.h"

namespace maploop::sensors {
namespace {

using Handle = std::unique_ptr<std::remove_pointer_t<tjhandle>, decltype(&tjDestroy)>;

const unsigned char* bytes_of(std::span<const char> file) {
  return reinterpret_cast<const unsigned char*>(file.data());
}

}  // namespace

GreyImage decode_grey_jpeg(std::span<const char> file) {
  const Handle jpeg(tjInitDecompress(), &tjDestroy);
  if (!jpeg) throw std::bad_alloc();
  const auto check = [&](int error) {
    if (error != 0) {
      throw std::runtime_error("the image is not a JPEG, or is incomplete or damaged (" +
                               std::string(tjGetErrorStr2(jpeg.get())) + ")");
    }
  };
  int width = 0, height = 0, subsampling = 0, colours = 0;
  check(tjDecompressHeader3(jpeg.get(), bytes_of(file), file.size(), &width, &height, &subsampling,
                            &colours));
  require_size(width, height);
  GreyImage image;
  image.resize(width, height);
  check(tjDecompress2(jpeg.get(), bytes_of(file), file.size(), image.pixels.data(), width, 0,
                      height, TJPF_GRAY, 0));
  return image;
}

void encode_jpeg(std::span<const std::uint8_t> pixels, int width, int height, int quality,
                 std::vector<std::uint8_t>& file) {
  const bool grey = is_grey(pixels.size(), width, height);
  const Handle jpeg(tjInitCompress(), &tjDestroy);
  if (!jpeg) throw std::bad_alloc();
  const int subsampling = grey ? TJSAMP_GRAY : TJSAMP_420;
  file.resize(tjBufSize(width, height, subsampling));
  unsigned char* to = file.data();
  unsigned long size = file.size();
  if (tjCompress2(jpeg.get(), pixels.data(), width, 0, height, grey ? TJPF_GRAY : TJPF_RGB, &to,
                  &size, subsampling, quality, TJFLAG_NOREALLOC) != 0) {
    throw std::runtime_error("the image cannot be encoded: " +
                             std::string(tjGetErrorStr2(jpeg.get())));
  }
  file.resize(size);
}

}  // namespace maploop::sensors
