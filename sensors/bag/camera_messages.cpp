#include "sensors/bag/camera_messages.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <string>

#include "msgs/input_limits.h"
#include "sensors/image/jpeg.h"
#include "sensors/image/png.h"

namespace maploop::sensors {
namespace {

enum class Layout : std::uint8_t { grey, colour, bayer };

struct Encoding {
  std::string_view name;
  Layout layout;
  std::size_t bytes;  // of a pixel
  std::size_t red, green,
      blue;  // byte of each in a pixel; of grey and Bayer: the byte that is read
};

constexpr std::array encodings{Encoding{"mono8", Layout::grey, 1, 0, 0, 0},
                               Encoding{"8UC1", Layout::grey, 1, 0, 0, 0},
                               Encoding{"mono16", Layout::grey, 2, 1, 1, 1},
                               Encoding{"16UC1", Layout::grey, 2, 1, 1, 1},
                               Encoding{"rgb8", Layout::colour, 3, 0, 1, 2},
                               Encoding{"bgr8", Layout::colour, 3, 2, 1, 0},
                               Encoding{"rgba8", Layout::colour, 4, 0, 1, 2},
                               Encoding{"bgra8", Layout::colour, 4, 2, 1, 0},
                               Encoding{"8UC3", Layout::colour, 3, 2, 1, 0},
                               Encoding{"8UC4", Layout::colour, 4, 2, 1, 0},
                               Encoding{"bayer_rggb8", Layout::bayer, 1, 0, 0, 0},
                               Encoding{"bayer_bggr8", Layout::bayer, 1, 0, 0, 0},
                               Encoding{"bayer_gbrg8", Layout::bayer, 1, 0, 0, 0},
                               Encoding{"bayer_grbg8", Layout::bayer, 1, 0, 0, 0}};

std::uint8_t luma(const std::uint8_t* pixel, const Encoding& e) {
  return static_cast<std::uint8_t>(
      (299 * pixel[e.red] + 587 * pixel[e.green] + 114 * pixel[e.blue] + 500) / 1000);
}

// At the border, rows and columns are mirrored about the outermost one, which keeps the pattern.
void smooth_bayer(const RosImage& image, GreyImage& grey) {
  const auto mirrored = [](int i, int size) {
    return i < 0 ? -i : i >= size ? 2 * size - 2 - i : i;
  };
  const int width = grey.width, height = grey.height;
  for (int v = 0; v < height; ++v) {
    const auto row = [&](int i) {
      return image.data.data() + static_cast<std::size_t>(mirrored(i, height)) * image.step;
    };
    const std::uint8_t *above = row(v - 1), *here = row(v), *below = row(v + 1);
    std::uint8_t* out = grey.pixels.data() + static_cast<std::ptrdiff_t>(v) * width;
    for (int u = 0; u < width; ++u) {
      const int l = mirrored(u - 1, width), r = mirrored(u + 1, width);
      const auto sum = [&](const std::uint8_t* p) { return p[l] + 2 * p[u] + p[r]; };
      out[u] = static_cast<std::uint8_t>((sum(above) + 2 * sum(here) + sum(below) + 8) / 16);
    }
  }
}

void check_size(std::uint64_t width, std::uint64_t height) {
  constexpr std::uint64_t least = 2;
  if (width < least || height < least ||
      width > static_cast<std::uint64_t>(input_limits::pixels) / height) {
    throw std::invalid_argument("its size of " + std::to_string(width) + " x " +
                                std::to_string(height) + " px is out of range");
  }
}

// A list of coefficients may go on with zeros, which is what a lens without them has.
Distortion distortion_of(const RosCameraInfo& info) {
  std::array<double, 8> d{};
  const auto zero = [](double coefficient) { return coefficient == 0.0; };
  const auto listed = std::min(info.d.size(), d.size());
  const bool longer =
      !std::all_of(info.d.begin() + static_cast<std::ptrdiff_t>(listed), info.d.end(), zero);
  std::copy_n(info.d.begin(), listed, d.begin());
  const std::string_view model = info.distortion_model;
  if (!longer && (model == "equidistant" || model == "fisheye") &&
      std::all_of(d.begin() + 4, d.end(), zero)) {
    return {.k1 = d[0], .k2 = d[1], .k3 = d[2], .k4 = d[3], .lens = Lens::equidistant};
  }
  const bool plain = std::all_of(d.begin() + 5, d.end(), zero);
  if (!longer && (model == "rational_polynomial" || (model == "plumb_bob" && plain) ||
                  std::all_of(d.begin(), d.end(), zero))) {
    return {d[0], d[1], d[2], d[3], d[4], d[5], d[6], d[7]};
  }
  throw std::invalid_argument("its distortion '" + std::string(model) + "' of " +
                              std::to_string(info.d.size()) +
                              " coefficients is not plumb_bob, rational_polynomial of 8, or "
                              "equidistant of 4; rectify the images, or calibrate the cameras with "
                              "maploop calibrate");
}

CameraModel model_of(const RosCameraInfo& info) {
  return {info.k[0], info.k[4], info.k[2], info.k[5], distortion_of(info)};
}

Eigen::Matrix3d rectification_of(const RosCameraInfo& info) {
  using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const auto rotation = nearest_rotation(Eigen::Map<const Rows>(info.r));
  if (!rotation) throw std::invalid_argument("its R is not a rotation");
  return *rotation;
}

}  // namespace

void to_grey(const RosImage& image, GreyImage& grey) {
  const auto e = std::ranges::find(encodings, image.encoding, &Encoding::name);
  if (e == encodings.end()) {
    throw std::invalid_argument("its encoding '" + std::string(image.encoding) +
                                "' is not supported");
  }
  check_size(image.width, image.height);
  const std::size_t row = image.width * e->bytes;
  if (image.step < row || image.data.size() / image.step < image.height) {
    throw std::invalid_argument(std::to_string(image.data.size()) + " bytes are too few for " +
                                std::to_string(image.height) + " rows of " +
                                std::to_string(image.step) + " bytes");
  }
  grey.resize(static_cast<int>(image.width), static_cast<int>(image.height));
  if (e->layout == Layout::bayer) {
    smooth_bayer(image, grey);
    return;
  }
  const std::size_t which = image.big_endian && e->bytes == 2 ? 0 : e->red;
  std::uint8_t* out = grey.pixels.data();
  for (std::uint32_t v = 0; v < image.height; ++v) {
    const std::uint8_t* in = image.data.data() + static_cast<std::size_t>(v) * image.step;
    if (e->bytes == 1) {
      std::memcpy(out, in, image.width);
      out += image.width;
      continue;
    }
    for (std::uint32_t u = 0; u < image.width; ++u, in += e->bytes)
      *out++ = e->layout == Layout::grey ? in[which] : luma(in, *e);
  }
}

void to_grey(const RosCompressedImage& image, GreyImage& grey) {
  const std::span file(reinterpret_cast<const char*>(image.data.data()), image.data.size());
  if (file.size() > input_limits::picture) throw std::invalid_argument("it is larger than 64 MB");
  grey = is_png(file) ? decode_any_png(file) : decode_grey_jpeg(file);
}

RosStereo stereo_of(const RosCameraInfo& left, const RosCameraInfo& right,
                    bool images_are_rectified) {
  const double baseline = (left.p[3] - right.p[3]) / left.p[0];
  if (!(left.p[0] > 0.0 && right.p[0] > 0.0))
    throw std::invalid_argument("it is not calibrated: P is zero");
  if (!(baseline > 0.0)) {
    throw std::invalid_argument(
        "the cameras are not calibrated as a pair: the baseline of their P is " +
        std::to_string(baseline) + " m");
  }
  if (left.width != right.width || left.height != right.height)
    throw std::invalid_argument("the two cameras have images of different sizes");
  check_size(left.width, left.height);
  RosStereo stereo;
  StereoCalibration& s = stereo.rectified;
  s.width = static_cast<int>(left.width);
  s.height = static_cast<int>(left.height);
  s.fx = left.p[0];
  s.fy = left.p[5];
  s.cx = left.p[2];
  s.cy = left.p[6];
  s.baseline = baseline;
  const auto plain = [](const RosCameraInfo& info) {
    return std::ranges::all_of(info.d, [](double d) { return d == 0.0; }) &&
           distortion_of(info).lens != Lens::equidistant && rectification_of(info).isIdentity();
  };
  if (images_are_rectified || (plain(left) && plain(right))) return stereo;
  StereoRig rig;
  rig.width = s.width;
  rig.height = s.height;
  rig.left = model_of(left);
  rig.right = model_of(right);
  rig.R_rect_left = rectification_of(left);
  rig.R_rect_right = rectification_of(right);
  // x_rect_right = x_rect_left - (baseline, 0, 0).
  rig.T_right_left.linear() = rig.R_rect_right.transpose() * rig.R_rect_left;
  rig.T_right_left.translation() =
      rig.R_rect_right.transpose() * Eigen::Vector3d(-baseline, 0.0, 0.0);
  rig.rectified = s;
  if (const auto problem = problem_of(rig)) throw std::invalid_argument(*problem);
  stereo.raw = rig;
  return stereo;
}

}  // namespace maploop::sensors
