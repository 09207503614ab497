#include "tools/calibrate/calibration_output.h"

#include <algorithm>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "sensors/camera/rectifier.h"
#include "sensors/image/jpeg.h"
#include "tools/web/html.h"
#include "tools/web/page.h"

namespace maploop::calibrate {
namespace {

using web::escaped;

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

void add(web::Line& line, double x, double y) {
  line.x.push_back(x);
  line.y.push_back(y);
}

// Returns a line for each camera, to which `add_view(view, side, line)` has added every view.
template <class AddView>
std::vector<web::Line> of_cameras(const StereoResult& r, web::Line::Look look,
                                  const AddView& add_view) {
  std::vector<web::Line> lines{{"left", {}, {}, look}, {"right", {}, {}, look}};
  for (const ViewResult& view : r.views)
    for (std::size_t side = 0; side < 2; ++side) add_view(view, side, lines[side]);
  return lines;
}

web::Plot view_plot(const StereoResult& r) {
  const auto add_view = [](const ViewResult& view, std::size_t side, web::Line& line) {
    add(line, static_cast<double>(line.x.size() + 1), rms_of(view.residuals)[side]);
  };
  return {"Reprojection error of each view", "number of the view", "px",
          of_cameras(r, web::Line::Look::solid, add_view)};
}

web::Plot residual_plot(const StereoResult& r) {
  const auto add_view = [](const ViewResult& view, std::size_t side, web::Line& line) {
    for (const Eigen::Vector2d& e : view.residuals[side]) add(line, e.x(), -e.y());
  };
  return {"Residuals", "px to the right", "px upwards",
          of_cameras(r, web::Line::Look::points, add_view), true};
}

// Shows all corners of one camera, and the outlines of the fields without a corner.
web::Plot coverage_plot(const StereoResult& r, std::size_t camera) {
  const double width = r.rig.width, height = r.rig.height;
  const auto corners = of_cameras(
      r, web::Line::Look::points, [&](const ViewResult& view, std::size_t side, web::Line& line) {
        for (const Eigen::Vector2d& c : side == 0 ? view.view.left : view.view.right)
          add(line, c.x(), height - c.y());
      });
  web::Plot plot{"Coverage", "px", "px above the lower edge", {corners[camera]}, true};
  const double w = width / Coverage::columns, h = height / Coverage::rows;
  for (int row = 0; row < Coverage::rows; ++row)
    for (int column = 0; column < Coverage::columns; ++column) {
      const auto i = static_cast<std::size_t>(row * Coverage::columns + column);
      if (r.coverage[camera].corners[i] > 0) continue;
      const double x = column * w, y = height - row * h;
      plot.roads.push_back({"no corner", {x, x + w, x + w, x, x}, {y, y, y - h, y - h, y}});
    }
  return plot;
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
  return web::Page("Stereo calibration")
      .add("<pre>" + escaped(to_text(r, unusable)) + "</pre>\n")
      .add({view_plot(r), residual_plot(r), coverage_plot(r, 0), coverage_plot(r, 1)})
      .add(pictures_of(r, pairs))
      .text();
}

}  // namespace maploop::calibrate
