#include "sensors/cloud/cloud_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "msgs/input_file.h"
#include "msgs/named_enum.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {
namespace {

const CloudTable scan{{"x", "y", "z", "intensity", "time"},
                      {1.5F, -2.25F, 0.1F, 0.5F, -0.05F, 1e-7F, 3e5F, -0.0F, 0.25F, 0.05F}};

class Encoding : public ::testing::TestWithParam<std::tuple<const char*, CloudEncoding>> {};

TEST_P(Encoding, WhatIsWrittenIsReadBackBitByBit) {
  const auto [file, encoding] = GetParam();
  const Cloud cloud = parse_cloud(encode_cloud(scan, file, encoding));
  ASSERT_EQ(cloud.points.size(), 2U);
  ASSERT_EQ(cloud.times.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const float* expected = &scan.values[5 * i];
    EXPECT_EQ(std::memcmp(&cloud.points[i], expected, sizeof(LidarPoint)), 0) << i;
    EXPECT_EQ(static_cast<float>(cloud.times[i]), expected[4]);
  }
}

using enum CloudEncoding;
INSTANTIATE_TEST_SUITE_P(Of, Encoding,
                         ::testing::Values(std::tuple("a.pcd", ascii), std::tuple("a.pcd", binary),
                                           std::tuple("a.pcd", compressed),
                                           std::tuple("a.ply", ascii), std::tuple("a.ply", binary)),
                         [](const auto& of) {
                           return std::string(std::get<0>(of.param)).substr(2) +
                                  std::string(to_string(std::get<1>(of.param)));
                         });

TEST(CloudFile, WritesOnlyWhatItsFormatsCanBe) {
  EXPECT_THROW(check_cloud_name("cloud.xyz", binary), std::runtime_error);
  EXPECT_THROW(check_cloud_name("cloud.ply", compressed), std::runtime_error);
  EXPECT_NO_THROW(check_cloud_name("cloud.pcd", compressed));
}

TEST(CloudFile, PlyNamesNormalsAsOthersDo) {
  const CloudTable table{{"x", "y", "z", "normal_x"}, {1, 2, 3, 1}};
  const std::string ply = encode_cloud(table, "a.ply", ascii);
  EXPECT_NE(ply.find("property float nx\n"), std::string::npos) << ply;
  EXPECT_NE(ply.find("end_header\n1 2 3 1\n"), std::string::npos) << ply;
}

// An organized cloud of another program: other types and fields, values of several numbers, CRLF,
// points without a return.
TEST(CloudFile, ReadsTypesAndFieldsInAnyOrderAndDropsMissingReturns) {
  const Cloud pcd = parse_cloud(
      "# .PCD v.7\r\nVERSION .7\r\nFIELDS t shape z y x reflectivity\r\nSIZE 4 4 4 4 8 2\r\n"
      "TYPE U F F F F U\r\nCOUNT 1 2 1 1 1 1\r\nWIDTH 3\r\nHEIGHT 1\r\nVIEWPOINT 0 0 0 1 0 0 0\r\n"
      "POINTS 3\r\nDATA ascii\r\n100 9 9 3 2 1 40\r\n200 9 9 nan nan nan 0\r\n\r\n"
      "300 9 9 6 5 4 80\r\n");
  ASSERT_EQ(pcd.points.size(), 2U);
  EXPECT_EQ(pcd.points[1].x, 4.0F);
  EXPECT_EQ(pcd.points[1].reflectance, 80.0F);
  EXPECT_EQ(pcd.times, (std::vector<double>{100.0, 300.0}));
  std::string ply =
      "ply\nformat binary_little_endian 1.0\ncomment made\nelement vertex 1\nproperty uchar r\n"
      "property int x\nproperty short y\nproperty char z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  ply.append("\x07\xff\xff\xff\xff\x00\x80\xfe", 8).append("faces");
  const Cloud cloud = parse_cloud(ply);
  EXPECT_EQ(cloud.points.at(0).x, -1.0F);
  EXPECT_EQ(cloud.points.at(0).y, -32768.0F);
  EXPECT_EQ(cloud.points.at(0).z, -2.0F);
  EXPECT_TRUE(cloud.times.empty());
}

constexpr const char* pcd_head =
    "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\n";

TEST(CloudFile, NamesThePlaceOfAnErrorAndItsReason) {
  const std::string head = pcd_head;
  const std::vector<std::pair<std::string, std::string>> broken{
      {"", "line 0: neither a PCD"},
      {"0 0 0\n1 1 1\n", "neither a PCD, whose header ends with DATA, nor a PLY"},
      {head + "DATA text\n", "line 8: DATA must be ascii, binary or binary_compressed"},
      {head + "DATA ascii\n1 2 3\n4.00 5.00\n", "line 10: point 2 of 2 has 2 values in place of 3"},
      {head + "DATA ascii\n1 2 3\n4 five 6\n", "line 10: 'five' in place 2 is not a number"},
      {head + "DATA ascii\n1 2 3\n", "line 8: the file is cut: 2 points"},
      {head + "DATA binary\n0123456789", "line 8: the file is cut: 2 points"},
      {head + "DATA binary_compressed\n0123456789", "the compressed data are of"},
      {head + "DATA binary_compressed\n" + std::string("\x05\0\0\0\x18\0\0\0abcde", 13),
       "cut or damaged"},
      {head + "DATA binary_compressed\n" + std::string("\xff\xff\0\0\x18\0\0\0abcde", 13),
       "cut or damaged"},
      {head + "POINTS -2\nDATA ascii\n", "'-2' in place 2 is not a number"},
      {head + "POINTS 4000000000\nDATA binary_compressed\n", "at most"},
      {head + "SIZE 4 4\nDATA ascii\n", "SIZE with a value for each"},
      {head + "SIZE 4 4 3\nDATA ascii\n", "field 'z' has no known type, size and count"},
      {head + "COUNT 1 1 70000\nDATA ascii\n", "field 'z'"},
      {head + "FIELDS x y w\nDATA ascii\n1 1 1\n1 1 1\n", "no fields x, y and z"},
      {head + "DATA ascii\nnan 0 0\n0 inf 0\n", "the cloud has no finite point"},
      {"ply\nformat ascii 1.0\nelement vertex 1\n", "no end_header"},
      {"ply\nformat binary_big_endian 1.0\n", "line 2: the format must be"},
      {"ply\nelement face 1\n", "line 2: the first element"},
      {"ply\nelement vertex 1\nproperty list uchar int x\n", "line 3: a vertex has no property"}};
  for (const auto& [content, reason] : broken) {
    try {
      parse_cloud(content);
      ADD_FAILURE() << content;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos)
          << error.what() << "\nin place of " << reason;
    }
  }
}

TEST(CloudFile, AnErrorNamesTheFile) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "broken.pcd";
  std::ofstream(file) << pcd_head << "DATA ascii\n1 2 3\n4.00 5.00\n";
  try {
    read_cloud(file);
    FAIL();
  } catch (const FileError& error) {
    EXPECT_EQ(error.what(), file.string() + ": line 10: point 2 of 2 has 2 values in place of 3");
  }
  EXPECT_THROW(read_cloud(folder.path() / "missing.ply"), FileError);
}

}  // namespace
}  // namespace maploop::sensors
