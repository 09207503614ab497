// These tests compare images in files with OpenCV's own readers and writers.
#include <gtest/gtest.h>
#include <zlib.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <span>
#include <string>

#include "sensors/image/jpeg.h"
#include "sensors/image/png.h"
#include "tests/support/error_of.h"

namespace maploop::sensors {
namespace {

using maploop::testing::error_of;
using ::testing::HasSubstr;

constexpr int width = 67, height = 41;

// Returns a smooth picture of any of OpenCV's types.
cv::Mat picture(int type) {
  cv::Mat made(height, width, CV_MAKETYPE(CV_8U, CV_MAT_CN(type)));
  std::mt19937 random(7);
  cv::Mat small(5, 7, made.type());
  for (std::uint8_t& value : std::span(small.data, small.total() * small.elemSize()))
    value = static_cast<std::uint8_t>(random());
  cv::resize(small, made, made.size(), 0.0, 0.0, cv::INTER_CUBIC);
  if (CV_MAT_DEPTH(type) == CV_16U) made.convertTo(made, type, 257.0);
  return made;
}

std::vector<char> encoded(const std::string& format, const cv::Mat& image,
                          const std::vector<int>& options = {}) {
  std::vector<std::uint8_t> file;
  cv::imencode(format, image, file, options);
  return {file.begin(), file.end()};
}

std::vector<std::uint8_t> pixels_of(const cv::Mat& image) {
  return {image.data, image.data + image.total() * image.elemSize()};
}

// Returns the largest difference of grey values.
double difference(const GreyImage& image, const cv::Mat& other) {
  EXPECT_EQ(image.width, other.cols);
  EXPECT_EQ(image.height, other.rows);
  return cv::norm(
      cv::Mat(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data())),
      other, cv::NORM_INF);
}

TEST(Png, GreyPixelsAreThoseOfOpenCv) {
  const cv::Mat image = picture(CV_8UC1);
  GreyImage decoded;
  decode_grey_png(encoded(".png", image), width, height, decoded);
  EXPECT_EQ(decoded.pixels, pixels_of(image));
  EXPECT_EQ(decode_any_png(encoded(".png", image)).pixels, pixels_of(image));
}

TEST(Png, TwoGreysAreEightBitsAfterwards) {
  cv::Mat image = picture(CV_8UC1) > 127;
  GreyImage decoded;
  decode_grey_png(encoded(".png", image, {cv::IMWRITE_PNG_BILEVEL, 1}), width, height, decoded);
  EXPECT_EQ(decoded.pixels, pixels_of(image));
}

TEST(Png, ColoursSixteenBitsAndTransparencyBecomeGrey) {
  for (const int type : {CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3}) {
    const cv::Mat image = picture(type);
    cv::Mat grey;
    image.convertTo(grey, CV_8U, CV_MAT_DEPTH(type) == CV_16U ? 1.0 / 257.0 : 1.0);
    if (image.channels() > 1)
      cv::cvtColor(grey, grey, image.channels() == 3 ? cv::COLOR_BGR2GRAY : cv::COLOR_BGRA2GRAY);
    EXPECT_LE(difference(decode_any_png(encoded(".png", image)), grey), 1.0) << "type " << type;
    GreyImage decoded;
    EXPECT_THROW(decode_grey_png(encoded(".png", image), width, height, decoded),
                 std::runtime_error);
  }
}

TEST(Png, WhatIsWrittenIsReadByOpenCv) {
  for (const PngContent content : {PngContent::picture, PngContent::noise}) {
    for (const int type : {CV_8UC1, CV_8UC3}) {
      const cv::Mat image = picture(type);
      cv::Mat read =
          cv::imdecode(encode_png(pixels_of(image), width, height, content), cv::IMREAD_UNCHANGED);
      if (read.channels() == 3) cv::cvtColor(read, read, cv::COLOR_BGR2RGB);
      EXPECT_EQ(pixels_of(read), pixels_of(image));
    }
  }
  EXPECT_THROW(encode_png(std::vector<std::uint8_t>(width * height + 1), width, height),
               std::runtime_error);
}

TEST(Png, AnImmenseImageIsRefusedByItsHeader) {
  std::vector<char> file = encoded(".png", picture(CV_8UC1));
  const std::string header("IHDR\0\0\xff\xff\0\0\xff\xff\x08\0\0\0\0", 17);
  std::copy(header.begin(), header.end(), file.begin() + 12);
  const auto crc = static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(header.data()), static_cast<uInt>(header.size())));
  for (int i = 0; i < 4; ++i)
    file[static_cast<std::size_t>(29 + i)] = static_cast<char>(crc >> (24 - 8 * i));
  EXPECT_THAT(error_of([&] { decode_any_png(file); }),
              HasSubstr("65535 x 65535 pixels, more than"));
}

TEST(Jpeg, GreyPixelsAreThoseOfOpenCv) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    const std::vector<char> file = encoded(".jpg", picture(type), {cv::IMWRITE_JPEG_QUALITY, 95});
    EXPECT_LE(difference(decode_grey_jpeg(file), cv::imdecode(file, cv::IMREAD_GRAYSCALE)), 1.0);
  }
}

TEST(Jpeg, WhatIsWrittenIsReadByOpenCv) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    const cv::Mat image = picture(type);
    std::vector<std::uint8_t> file;
    encode_jpeg(pixels_of(image), width, height, 95, file);
    cv::Mat read = cv::imdecode(file, cv::IMREAD_UNCHANGED);
    if (read.channels() == 3) cv::cvtColor(read, read, cv::COLOR_BGR2RGB);
    ASSERT_EQ(read.size(), image.size());
    EXPECT_LT(cv::norm(read, image, cv::NORM_L1) / static_cast<double>(pixels_of(image).size()),
              type == CV_8UC1 ? 1.0 : 4.0);
  }
}

TEST(Jpeg, CutOrDamagedIsRefused) {
  const std::vector<char> file = encoded(".jpg", picture(CV_8UC1));
  for (std::size_t length = 0; length < file.size() - 1; length += 7)
    EXPECT_THROW(decode_grey_jpeg(std::span(file).first(length)), std::runtime_error) << length;
  EXPECT_THROW(decode_grey_jpeg(encoded(".png", picture(CV_8UC1))), std::runtime_error);
}

}  // namespace
}  // namespace maploop::sensors
