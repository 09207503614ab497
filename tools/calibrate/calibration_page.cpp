#include "tools/calibrate/calibration_page.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "sensors/camera/rectifier.h"
#include "sensors/image/jpeg.h"
#include "tools/calibrate/calibration_text.h"
#include "tools/web/html.h"
#include "tools/web/page.h"

namespace maploop::calibrate {
namespace {

using web::escaped;

std::string number(double value) {
  return fmt::format("{:.3f}", value);
}

// `width` is the width on the page, px.
std::string picture(const cv::Mat& image, int width) {
  std::vector<std::uint8_t> jpeg;
  cv::Mat rgb;
  cv::cvtColor(image, rgb, cv::COLOR_BGR2RGB);
  sensors::encode_jpeg({rgb.data, 3 * rgb.total()}, rgb.cols, rgb.rows, 80, jpeg);
  return web::image(jpeg, "jpeg", width);
}

cv::Mat in_colour(const GreyImage& image) {
  const cv::Mat grey(image.height, image.width, CV_8UC1,
                     const_cast<std::uint8_t*>(image.pixels.data()));
  cv::Mat colour;
  cv::cvtColor(grey, colour, cv::COLOR_GRAY2BGR);
  return colour;
}

// Draws the image with its corners, and their residuals enlarged.
cv::Mat with_corners(const GreyImage& image, const Corners& corners, const Corners& residuals) {
  constexpr double enlarged = 100.0;
  constexpr int bits = 4;  // fraction bits of OpenCV's coordinates
  const auto at = [](const Eigen::Vector2d& p) {
    return cv::Point(cvRound(p.x() * (1 << bits)), cvRound(p.y() * (1 << bits)));
  };
  cv::Mat drawn = in_colour(image);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    cv::circle(drawn, at(corners[i]), 3 << bits, {0, 200, 0}, 1, cv::LINE_AA, bits);
    cv::line(drawn, at(corners[i]), at(corners[i] + enlarged * residuals[i]), {0, 0, 255}, 1,
             cv::LINE_AA, bits);
  }
  cv::circle(drawn, at(corners.front()), 6 << bits, {255, 120, 0}, 2, cv::LINE_AA, bits);
  return drawn;
}

// Draws both images side by side, with lines along rows.
cv::Mat with_rows(const StereoPair& rectified) {
  constexpr int lines = 16;
  cv::Mat both;
  cv::hconcat(in_colour(rectified.left), in_colour(rectified.right), both);
  for (int i = 1; i < lines; ++i) {
    const int y = both.rows * i / lines;
    cv::line(both, {0, y}, {both.cols - 1, y}, {0, 200, 255}, 1);
  }
  return both;
}

std::string svg(double width, double height, const std::string& content) {
  return "<svg xmlns='http://www.w3.org/2000/svg' width='" + number(width) + "' height='" +
         number(height) + "' font-family='sans-serif' font-size='11'>" + content + "</svg>\n";
}

std::string rectangle(double x, double y, double width, double height, const std::string& fill) {
  return "<rect x='" + number(x) + "' y='" + number(y) + "' width='" + number(width) +
         "' height='" + number(height) + "' fill='" + fill + "' stroke='#bbb'/>";
}

std::string dot(double x, double y, const char* colour) {
  return "<circle cx='" + number(x) + "' cy='" + number(y) + "' r='1.5' fill='" + colour + "'/>";
}

constexpr std::array kColours = {"#1f77b4", "#d62728"};  // left, right

// Plots all corners of one camera, over the fields that have a corner.
std::string coverage_plot(const StereoResult& r, std::size_t side) {
  constexpr double width = 560.0;
  const double scale = width / r.rig.width, height = scale * r.rig.height;
  std::string content;
  const double w = width / Coverage::columns, h = height / Coverage::rows;
  for (int row = 0; row < Coverage::rows; ++row)
    for (int column = 0; column < Coverage::columns; ++column) {
      const auto i = static_cast<std::size_t>(row * Coverage::columns + column);
      content += rectangle(column * w, row * h, w, h,
                           r.coverage[side].corners[i] > 0 ? "#eef6ee" : "#fbe3e0");
    }
  for (const ViewResult& view : r.views)
    for (const Eigen::Vector2d& c : side == 0 ? view.view.left : view.view.right)
      content += dot(scale * c.x(), scale * c.y(), kColours[side]);
  return svg(width, height, content);
}

// Plots residuals around zero; the frame extends four root mean squares to each side.
std::string residual_plot(const StereoResult& r, std::size_t side) {
  constexpr double size = 300.0;
  const double range = std::max(4.0 * r.adjustment.rms, 1e-6), scale = 0.5 * size / range;
  std::string content = rectangle(0.0, 0.0, size, size, "none");
  for (const double at : {-0.5, 0.0, 0.5}) {
    const std::string p = number(0.5 * size * (1.0 + at)), end = number(size);
    content += "<line x1='" + p + "' x2='" + p + "' y1='0' y2='" + end + "' stroke='#ddd'/>" +
               "<line y1='" + p + "' y2='" + p + "' x1='0' x2='" + end + "' stroke='#ddd'/>";
  }
  for (const ViewResult& view : r.views)
    for (const Eigen::Vector2d& e : view.residuals[side])
      content += dot(0.5 * size + scale * e.x(), 0.5 * size + scale * e.y(), kColours[side]);
  content += "<text x='4' y='" + number(size - 5.0) + "'>frame: +-" + number(range) + " px</text>";
  return svg(size, size, content);
}

std::string bars(const StereoResult& r) {
  constexpr double length = 300.0, step = 16.0, names = 200.0;
  double longest = 1e-9;
  for (const ViewResult& view : r.views)
    for (const double rms : rms_of(view.residuals)) longest = std::max(longest, rms);
  std::string content;
  double y = 0.0;
  for (const ViewResult& view : r.views) {
    content += "<text x='0' y='" + number(y + 11.0) + "'>" + escaped(view.view.name) + "</text>";
    const auto rms = rms_of(view.residuals);
    for (std::size_t side = 0; side < 2; ++side) {
      const double bar = length * rms[side] / longest;
      content +=
          rectangle(names, y + 2.0 + 6.0 * static_cast<double>(side), bar, 6.0, kColours[side]);
    }
    content += "<text x='" + number(names + length + 8.0) + "' y='" + number(y + 11.0) + "'>" +
               number(rms[0]) + " / " + number(rms[1]) + " px</text>";
    y += step;
  }
  return svg(names + length + 120.0, y + 4.0, content);
}

const ImagePair* pair_of(const std::string& name, const std::vector<ImagePair>& pairs) {
  const auto found = std::find_if(pairs.begin(), pairs.end(),
                                  [&](const ImagePair& pair) { return pair.name == name; });
  return found == pairs.end() ? nullptr : &*found;
}

std::string pictures_of(const StereoResult& r, const std::vector<ImagePair>& pairs) {
  constexpr int page_width = 520;
  const sensors::Rectifier rectifier(r.rig);
  std::string views, rows;
  for (const ViewResult& view : r.views) {
    const ImagePair* files = pair_of(view.view.name, pairs);
    if (files == nullptr) continue;
    StereoPair raw, rectified;
    try {
      raw.left = read_image(files->left);
      raw.right = read_image(files->right);
    } catch (const std::runtime_error&) {
      continue;  // the file has disappeared since it was measured
    }
    if (rows.empty()) {
      rectifier.rectify(raw, rectified);
      rows = "<h2>Rectified pair</h2><p>" + escaped(view.view.name) +
             ": what is on one line of the left image is on the same line of the right one.</p>" +
             picture(with_rows(rectified), 2 * page_width);
    }
    views += "<p>" + escaped(view.view.name) + "<br>" +
             picture(with_corners(raw.left, view.view.left, view.residuals[0]), page_width) + " " +
             picture(with_corners(raw.right, view.view.right, view.residuals[1]), page_width) +
             "</p>\n";
  }
  return rows +
         "<h2>Views</h2><p>Green: corners found; blue: the first; red: measured minus "
         "projected, 100 times enlarged.</p>\n" +
         views;
}

}  // namespace

std::string to_page(const StereoResult& r, const std::vector<ImagePair>& pairs,
                    const std::vector<Unusable>& unusable) {
  std::string body = "<pre>" + escaped(to_text(r, unusable)) + "</pre>\n";
  body += "<h2>Reprojection error of each view</h2><p>Blue: left, red: right.</p>" + bars(r);
  body += "<h2>Residuals</h2>" + residual_plot(r, 0) + " " + residual_plot(r, 1);
  body += "<h2>Coverage</h2><p>Fields without a corner are red.</p>" + coverage_plot(r, 0) + " " +
          coverage_plot(r, 1);
  body += pictures_of(r, pairs);
  return web::Page("Stereo calibration").add(body).text();
}

}  // namespace maploop::calibrate
