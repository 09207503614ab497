// Tests `maploop calibrate` as users run it.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "runtime/vehicle/drivers/stereo_rig_file.h"
#include "sensors/image/png.h"
#include "tests/support/board_renderer.h"
#include "tests/support/process.h"

namespace maploop {
namespace {

namespace fs = std::filesystem;
using testing::ProcessResult;

ProcessResult calibrate(std::vector<std::string> arguments, const std::string& board = "9x6") {
  arguments.insert(arguments.begin(), {testing::maploop_command(), "calibrate"});
  arguments.insert(arguments.end(), {"--board", board, "--square", "0.03"});
  return testing::run(arguments);
}

void write(const fs::path& file, const GreyImage& image) {
  const std::vector<std::uint8_t> png =
      sensors::encode_png(image.pixels, image.width, image.height, sensors::PngContent::noise);
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
}

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

// Ten pairs in left/ and right/, rendered once.
class CalibrateCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new testing::TemporaryFolder;
    const testing::RenderedRig rig = testing::example_rig();
    testing::BoardRenderer renderer(rig);
    for (const char* side : {"left", "right"}) fs::create_directories(images() / side);
    std::uint32_t number = 0;
    for (const auto& pose : testing::board_poses(renderer, rig, {}, 10, 0.35, 0.6, 21)) {
      const StereoPair pair = renderer.render({}, pose, {}, ++number);
      const std::string name = "view" + std::to_string(number) + ".png";
      write(images() / "left" / name, pair.left);
      write(images() / "right" / name, pair.right);
    }
  }
  static void TearDownTestSuite() { delete folder; }

  static fs::path images() { return folder->path() / "images"; }
  static std::string file(const char* name) { return (folder->path() / name).string(); }

  // Returns a copy that a test may damage.
  static fs::path copy(const char* name) {
    fs::copy(images(), folder->path() / name, fs::copy_options::recursive);
    return folder->path() / name;
  }

  static inline testing::TemporaryFolder* folder = nullptr;
};

TEST_F(CalibrateCommand, WritesEveryFormOfTheCalibration) {
  const ProcessResult run =
      calibrate({images().string(), "--toml", file("c.toml"), "--kitti", file("c.txt"), "--json",
                 file("c.json"), "--html", file("c.html")});
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_NE(run.out.find("fundamental matrix"), std::string::npos) << run.out;

  const auto json = nlohmann::json::parse(text_of(file("c.json")));
  EXPECT_EQ(json["views"].size(), 10u);
  EXPECT_LT(json["rms_px"], 0.1);
  const auto& fx = json["parameters"]["left.fx"];
  EXPECT_NEAR(fx["value"], testing::example_rig().left.fx, 1.5);
  EXPECT_GT(fx["sigma"], 0.0);

  const sensors::StereoRig toml = vehicle::read_stereo_rig(file("c.toml"));
  const sensors::StereoRig kitti = vehicle::read_stereo_rig(file("c.txt"));
  EXPECT_EQ(toml.left.fx, fx["value"]);
  EXPECT_NEAR(kitti.left.fx, toml.left.fx, 1e-3);
  EXPECT_NEAR(kitti.rectified.baseline, toml.rectified.baseline, 1e-6);
  EXPECT_NEAR(kitti.right.distortion.k1, toml.right.distortion.k1, 1e-6);

  const std::string html = text_of(file("c.html"));
  EXPECT_NE(html.find("Rectified pair"), std::string::npos);
  EXPECT_EQ(html.find("src='http"), std::string::npos) << "the page needs a network";
  std::size_t pictures = 0;
  for (std::size_t at = 0; (at = html.find("data:image/jpeg", at)) != std::string::npos; ++at)
    ++pictures;
  EXPECT_EQ(pictures, 21u);  // two for each of ten views, and the rectified pair
}

TEST_F(CalibrateCommand, PatternsNameTheImagesAsWell) {
  const fs::path flat = folder->path() / "flat";
  fs::create_directories(flat);
  for (int i = 1; i <= 10; ++i)
    for (const std::string side : {"left", "right"})
      fs::copy_file(images() / side / ("view" + std::to_string(i) + ".png"),
                    flat / (side + "-" + std::to_string(i) + ".png"));
  for (const auto& names : std::vector<std::vector<std::string>>{
           {(flat / "left-*.png").string(), (flat / "right-*.png").string()}, {flat.string()}}) {
    auto arguments = names;
    arguments.insert(arguments.end(), {"--toml", file("p.toml")});
    EXPECT_EQ(calibrate(arguments).status, 0);
  }
}

TEST_F(CalibrateCommand, WhatCannotBeUsedIsNamedAndTheRestIs) {
  const fs::path damaged = copy("damaged");
  fs::remove(damaged / "right/view1.png");
  std::ofstream(damaged / "left/view2.png") << "no image";
  GreyImage empty, small;
  empty.resize(752, 480);
  small.resize(640, 480);
  write(damaged / "left/view3.png", empty);
  write(damaged / "right/view4.png", small);
  const ProcessResult run = calibrate({damaged.string(), "--toml", file("d.toml")});
  EXPECT_EQ(run.status, 0) << run.error;
  for (const char* said :
       {"left/view1.png: not used: it has no right image", "left/view2.png: not used: the image",
        "left/view3.png: not used: no board of 9x6", "right/view4.png: not used: it has 640 x 480"})
    EXPECT_NE(run.out.find(said), std::string::npos) << said << '\n' << run.out;
}

void expect_error(const ProcessResult& run, const std::string& said) {
  EXPECT_EQ(run.status, 1) << run.out;
  EXPECT_NE(run.error.find(said), std::string::npos) << run.error;
}

TEST_F(CalibrateCommand, ErrorsSayWhatIsWrong) {
  expect_error(calibrate({images().string(), "--toml", file("x.toml")}, "8x5"),
               "a board of 9x6 inner corners is seen");
  expect_error(calibrate({file("nowhere")}), "is not a folder");
  expect_error(calibrate({folder->path().string()}), "no pairs of images");
  expect_error(calibrate({file("images/left/*.png"), file("images/none*.png")}), "no image fits");

  const fs::path few = copy("few");
  for (int i = 4; i <= 10; ++i) fs::remove(few / "left" / ("view" + std::to_string(i) + ".png"));
  expect_error(calibrate({few.string()}), "too few views");

  const fs::path sizes = copy("sizes");
  GreyImage small;
  small.resize(640, 480);
  for (int i = 1; i <= 10; ++i)
    write(sizes / "right" / ("view" + std::to_string(i) + ".png"), small);
  expect_error(calibrate({sizes.string()}), "both must have the same size");
  EXPECT_FALSE(fs::exists(file("x.toml")));

  EXPECT_NE(calibrate({images().string()}, "9by6").status, 0);
}

}  // namespace
}  // namespace maploop
