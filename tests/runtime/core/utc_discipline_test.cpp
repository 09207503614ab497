#include "runtime/core/utc_discipline.h"

#include <gtest/gtest.h>

#include <chrono>

namespace maploop::runtime {
namespace {

timex kernel(int status) {
  timex t{};
  t.status = status;
  t.esterror = 12;
  t.maxerror = 1500;
  t.freq = -3 * 65536 - 32768;
  return t;
}

TEST(UtcDiscipline, IsWhatTheKernelSays) {
  const UtcDiscipline d = discipline_of(kernel(STA_PLL | STA_PPSSIGNAL));
  EXPECT_TRUE(d.synchronized);
  EXPECT_TRUE(d.pulse);
  EXPECT_EQ(d.estimated_error, std::chrono::microseconds(12));
  EXPECT_EQ(d.largest_error, std::chrono::microseconds(1500));
  EXPECT_DOUBLE_EQ(d.rate, -3.5);
  EXPECT_FALSE(discipline_of(kernel(STA_PLL)).pulse);
  EXPECT_FALSE(discipline_of(kernel(STA_PLL | STA_UNSYNC)).synchronized);
}

TEST(UtcDiscipline, ADisciplinedClockIsGrantedWithItsErrors) {
  const RealtimeSetting utc = assess(discipline_of(kernel(STA_PLL | STA_PPSSIGNAL)));
  EXPECT_EQ(utc.verdict, Verdict::granted);
  EXPECT_EQ(utc.granted,
            "disciplined to 0.012 ms, at most 1.500 ms, steered by -3.50 ppm, with a receiver's "
            "pulse");
}

TEST(UtcDiscipline, AClockOfItsOwnIsNamedWithItsRemedy) {
  const RealtimeSetting utc = assess(discipline_of(kernel(STA_UNSYNC)));
  EXPECT_EQ(utc.verdict, Verdict::limiting);
  EXPECT_EQ(utc.granted, "not disciplined, steered by -3.50 ppm");
  EXPECT_NE(utc.remedy.find("chrony"), std::string::npos);
}

TEST(UtcDiscipline, ThisMachinesKernelAnswers) {
  EXPECT_NE(assess_utc().verdict, Verdict::unknown);
}

}  // namespace
}  // namespace maploop::runtime
