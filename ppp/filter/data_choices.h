// These are the data on which values of [ppp] were chosen.
#pragma once

#include "msgs/parameter.h"

namespace maploop::ppp {

inline constexpr DataChoice code_sigma_choice{"ESBC station and Kamakura car",
                                              "among a handful of values with the scores in sight",
                                              "PPP of ESBC and of Kamakura"};
inline constexpr DataChoice phase_sigma_choice{"ESBC station and Kamakura car", "as `code_sigma`",
                                               "PPP of ESBC and of Kamakura"};
inline constexpr DataChoice code_correlation_choice{
    "ESBC station and Kamakura car", "from post-fit residuals of the days that are scored",
    "PPP of ESBC and of Kamakura"};
inline constexpr DataChoice code_correlation_distance_choice{
    "Kamakura car", "as `code_correlation`", "PPP of Kamakura"};
inline constexpr DataChoice glonass_code_correlation_choice{"ESBC station", "as `code_correlation`",
                                                            "PPP of ESBC with GLONASS"};
inline constexpr DataChoice carried_choice{"simulated canyons, seeds 1, 2, 4 and 5",
                                           "among four sets by the errors with slipping wheels",
                                           "PPP carried by motion, of these seeds"};
inline constexpr DataChoice outlier_sigmas_choice{"simulated canyons, seeds 1 to 10",
                                                  "among 2.5 to 6 by the scores",
                                                  "PPP between houses, seeds 1 to 10"};
inline constexpr DataChoice full_cn0_choice{"receivers of ESBC, Kamakura and Riverside",
                                            "the weakest 5 % of signals under open sky",
                                            "PPP of ESBC, Kamakura and Riverside"};
inline constexpr DataChoice full_cn0_drop_choice{"receivers of ESBC, Kamakura and Riverside",
                                                 "as `full_cn0`", "as `full_cn0`"};
inline constexpr DataChoice full_cn0_margin_choice{
    "simulated canyons, seeds 1 to 20, and the three receivers",
    "among 3 to 6 dB with the scores in sight",
    "PPP between houses, seeds 1 to 20; PPP of the three receivers"};
inline constexpr DataChoice full_cn0_first_step_choice{
    "simulated canyons, seeds 1 to 6, and towns, seeds 1 to 3",
    "among 0, 2, 4 and 8 dB by the errors", "PPP of these seeds"};
inline constexpr DataChoice ambiguity_walk_choice{
    "ESBC station", "from changes of post-fit phase residuals over 10 minutes", "PPP of ESBC"};
inline constexpr DataChoice wide_lane_sigma_choice{
    "ESBC station, 00:00 to 12:00 and as a vehicle",
    "among 0, 0.05, 0.1 and 0.15 cycles by the time to 0.1 m and the fixed epochs",
    "PPP of ESBC before 12:00"};
inline constexpr DataChoice integer_success_choice{
    "ESBC station, 00:00 to 12:00",
    "among 0.9 to 0.999 by the time to 0.1 m, none with wrong integers",
    "PPP of ESBC before 12:00"};
inline constexpr DataChoice integer_margin_choice{
    "ESBC station, 00:00 to 12:00 and as a vehicle",
    "among 10 to 30 by the time to 0.1 m and the fixed epochs, none with wrong integers",
    "PPP of ESBC before 12:00"};
inline constexpr DataChoice clock_difference_choice{
    "simulated canyons, seeds 1 to 10, ESBC station, Kamakura car and Riverside",
    "among 10 to 100 m by the errors in canyons; the three real receivers have 1 to 8 m",
    "PPP between houses, seeds 1 to 10; the first minutes of the others"};
inline constexpr DataChoice vertical_speed_choice{
    "simulated canyons, seeds 1 to 10, Riverside and Kamakura car",
    "among five pairs of 0.3 to 1 m/s and 10 to 20 s: the errors, and slopes of 5 % at 10 m/s",
    "PPP between houses, seeds 1 to 10; PPP of Riverside and of Kamakura"};
inline constexpr DataChoice range_error_time_choice{
    "ESBC station with broadcast orbits, 00:00 to 12:00", "among 1, 4 and 12 hours by the errors",
    "PPP of ESBC before 12:00 with broadcast orbits"};
inline constexpr DataChoice phase_correlation_choice{
    "simulated canyons, seeds 1 to 10, ESBC station before 12:00 and Kamakura car",
    "with `common_phase_sigma` among ten pairs of 1 to 20 s and 1 to 6 mm, by the errors",
    "PPP between houses, seeds 1 to 10; PPP of ESBC before 12:00 and of Kamakura"};
inline constexpr DataChoice common_sigma_choice{
    "simulated canyons, seeds 1 to 10, ESBC station and Kamakura car",
    "codes among 0 to 1 m, phases among 0 to 10 mm, by the errors",
    "PPP between houses, seeds 1 to 10; PPP of ESBC and of Kamakura"};
inline constexpr DataChoice measured_ionosphere_walk_choice{
    "simulated canyons, seeds 1 to 10", "among 3, 6, 10, 20 and 30 mm/sqrt(s) by the errors",
    "PPP between houses, seeds 1 to 10"};
inline constexpr DataChoice reflections_choice{
    "simulated canyons, seeds 1 to 10 and 101 to 130, Kamakura car and Riverside",
    "among a handful of values each by the errors in canyons; the real drives do not get worse",
    "PPP between houses, these seeds; PPP of Kamakura and of Riverside"};

}  // namespace maploop::ppp
