// Tests the file in which the filter of PPP is kept.
#include "runtime/vehicle/config/kept_ppp.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class KeptPpp : public ::testing::Test {
 protected:
  std::string error(const std::string& car) const {
    return maploop::testing::error_of([&] { read_kept_ppp(file_, car); });
  }

  maploop::testing::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "maploop.state.ppp";
  const Bytes filter_{1, 2, 3};
};

TEST_F(KeptPpp, ComesBackToTheBit) {
  EXPECT_FALSE(read_kept_ppp(file_, "golf")) << "there is no file yet";
  write_kept_ppp(file_, "golf", filter_);
  EXPECT_EQ(read_kept_ppp(file_, "golf"), filter_);
}

TEST_F(KeptPpp, AnotherCarsFileIsRefused) {
  write_kept_ppp(file_, "golf", filter_);
  EXPECT_THAT(error("polo"), AllOf(HasSubstr(file_.string()), HasSubstr("the car 'golf'"),
                                   HasSubstr("this is 'polo'")));
}

TEST_F(KeptPpp, ADamagedFileIsRefused) {
  write_kept_ppp(file_, "golf", filter_);
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) - 1);
  EXPECT_THAT(error("golf"), AllOf(HasSubstr(file_.string()), HasSubstr("cannot use")));
  std::ofstream(file_) << "not a filter";
  EXPECT_THAT(error("golf"), HasSubstr(file_.string()));
}

}  // namespace
}  // namespace maploop::vehicle
