#include "sensors/image/png.h"

#include <spng.h>
#include <zlib.h>

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "msgs/input_limits.h"
#include "sensors/image/image_size.h"

namespace maploop::sensors {
namespace {

using Context = std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)>;

Context context(int flags) {
  Context result(spng_ctx_new(flags), &spng_ctx_free);
  if (!result) throw std::bad_alloc();
  return result;
}

void check(int error) {
  if (error != 0) {
    throw std::runtime_error("the image is incomplete or damaged (" +
                             std::string(spng_strerror(error)) + ")");
  }
}

// This is a file whose header has been read.
struct Opened {
  Context context;
  spng_ihdr header;
};

Opened open(std::span<const char> file) {
  if (file.empty()) throw std::runtime_error("the file is empty");
  if (!is_png(file)) throw std::runtime_error("is not a PNG image");
  Opened opened{context(0), {}};
  // Texts and profiles beside the image are compressed too, and need a limit.
  check(spng_set_chunk_limits(opened.context.get(), input_limits::picture, input_limits::picture));
  check(spng_set_png_buffer(opened.context.get(), file.data(), file.size()));
  check(spng_get_ihdr(opened.context.get(), &opened.header));
  return opened;
}

// Decodes all pixels and reads the file to its end.
void decode(const Context& png, std::vector<std::uint8_t>& pixels, spng_format format) {
  check(spng_decode_image(png.get(), pixels.data(), pixels.size(), format, 0));
  check(spng_decode_chunks(png.get()));
}

}  // namespace

bool is_png(std::span<const char> file) {
  return std::string_view(file.data(), file.size()).starts_with("\x89PNG\r\n\x1a\n");
}

void decode_grey_png(std::span<const char> file, int width, int height, GreyImage& image) {
  const auto [png, header] = open(file);
  if (header.color_type != SPNG_COLOR_TYPE_GRAYSCALE || header.bit_depth > 8) {
    throw std::runtime_error("not an 8-bit grey image (the grey cameras are image_00, image_01)");
  }
  if (std::cmp_not_equal(header.width, width) || std::cmp_not_equal(header.height, height)) {
    throw std::runtime_error("the image is " + size_text(header.width, header.height) +
                             ", but the calibration states " + std::to_string(width) + " x " +
                             std::to_string(height));
  }
  image.resize(width, height);
  decode(png, image.pixels, SPNG_FMT_G8);
}

GreyImage decode_any_png(std::span<const char> file) {
  const auto [png, header] = open(file);
  require_size(header.width, header.height);
  GreyImage image;
  image.resize(static_cast<int>(header.width), static_cast<int>(header.height));
  if (header.color_type == SPNG_COLOR_TYPE_GRAYSCALE && header.bit_depth <= 8) {
    decode(png, image.pixels, SPNG_FMT_G8);
    return image;
  }
  std::vector<std::uint8_t> rgb(3 * image.pixels.size());
  decode(png, rgb, SPNG_FMT_RGB8);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const std::uint8_t* const p = &rgb[3 * i];
    image.pixels[i] =
        static_cast<std::uint8_t>((299 * p[0] + 587 * p[1] + 114 * p[2] + 500) / 1000);
  }
  return image;
}

std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> pixels, int width, int height,
                                     PngContent content) {
  const bool grey = is_grey(pixels.size(), width, height);
  const Context png = context(SPNG_CTX_ENCODER);
  spng_ihdr header{};
  header.width = static_cast<std::uint32_t>(width);
  header.height = static_cast<std::uint32_t>(height);
  header.bit_depth = 8;
  header.color_type = grey ? SPNG_COLOR_TYPE_GRAYSCALE : SPNG_COLOR_TYPE_TRUECOLOR;
  const auto encoded = [](int error) {
    if (error != 0)
      throw std::runtime_error("the image cannot be encoded: " + std::string(spng_strerror(error)));
  };
  encoded(spng_set_option(png.get(), SPNG_ENCODE_TO_BUFFER, 1));
  encoded(spng_set_option(png.get(), SPNG_IMG_COMPRESSION_LEVEL, 6));
  if (content == PngContent::noise)
    encoded(spng_set_option(png.get(), SPNG_IMG_COMPRESSION_STRATEGY, Z_HUFFMAN_ONLY));
  encoded(spng_set_ihdr(png.get(), &header));
  encoded(spng_encode_image(png.get(), pixels.data(), pixels.size(), SPNG_FMT_PNG,
                            SPNG_ENCODE_FINALIZE));
  std::size_t size = 0;
  int error = 0;
  const std::unique_ptr<void, decltype(&std::free)> file(
      spng_get_png_buffer(png.get(), &size, &error), &std::free);
  encoded(error);
  const auto* const bytes = static_cast<const std::uint8_t*>(file.get());
  return {bytes, bytes + size};
}

}  // namespace maploop::sensors
