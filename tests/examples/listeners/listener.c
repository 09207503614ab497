// Prints each NAV_STATE, in C. TYPES is the folder of the installed message types, share/maploop/lcm:
//   cc -I TYPES/c listener.c TYPES/c/*.c -llcm -o listener
#include <lcm/lcm.h>
#include <maploop_lcm_nav_state_t.h>
#include <stdio.h>

static void print(const lcm_recv_buf_t* buffer, const char* channel, const maploop_lcm_nav_state_t* s, void* user) {
  (void)buffer, (void)channel, (void)user;
  printf("%.3f s: east %.2f m, north %.2f m, azimuth %.4f rad\n", (double)s->header.stamp_ns * 1e-9, s->position_enu[0],
         s->position_enu[1], s->azimuth);
  fflush(stdout);
}

int main(void) {
  lcm_t* lcm = lcm_create(NULL);  // the default network, or that of LCM_DEFAULT_URL
  if (!lcm) return 1;
  maploop_lcm_nav_state_t_subscribe(lcm, "NAV_STATE", print, NULL);
  while (lcm_handle(lcm) == 0) continue;
  lcm_destroy(lcm);
  return 1;
}
