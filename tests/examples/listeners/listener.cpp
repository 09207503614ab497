// Prints each NAV_STATE, in C++. The message types are headers alone:
//   c++ listener.cpp -llcm -o listener
#include <cstdio>
#include <lcm/lcm-cpp.hpp>
#include <maploop_lcm/nav_state_t.hpp>

int main() {
  lcm::LCM lcm;  // the default network, or that of LCM_DEFAULT_URL
  if (!lcm.good()) return 1;
  const auto print = [](const lcm::ReceiveBuffer*, const std::string&,
                        const maploop_lcm::nav_state_t* s, void*) {
    std::printf("%.3f s: east %.2f m, north %.2f m, azimuth %.4f rad\n",
                static_cast<double>(s->header.stamp_ns) * 1e-9, s->position_enu[0],
                s->position_enu[1], s->azimuth);
    std::fflush(stdout);
  };
  lcm.subscribeFunction<maploop_lcm::nav_state_t, void*>("NAV_STATE", print, nullptr);
  while (lcm.handle() == 0) {
  }
  return 1;
}
