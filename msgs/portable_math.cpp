// Defines the functions of <cmath> that the C library would choose by processor. With SLEEF's
// "cinz" functions, which use no fused multiply-add, the same input gives the same bits on each
// processor; their error is at most 1 unit in the last place (Shibata and Petrogalli, "SLEEF: a
// portable vectorized library of C standard mathematical functions", IEEE Transactions on Parallel
// and Distributed Systems 31, 2020).
//
// A program's own definitions go before those of shared libraries, for the libraries too.
#include <sleef.h>

#define MAPLOOP_ONE_ARGUMENT(name)            \
  double name(double x) {                     \
    return Sleef_cinz_##name##d1_u10purec(x); \
  }                                           \
  float name##f(float x) {                    \
    return Sleef_cinz_##name##f1_u10purec(x); \
  }
#define MAPLOOP_TWO_ARGUMENTS(name)              \
  double name(double x, double y) {              \
    return Sleef_cinz_##name##d1_u10purec(x, y); \
  }                                              \
  float name##f(float x, float y) {              \
    return Sleef_cinz_##name##f1_u10purec(x, y); \
  }

#pragma GCC visibility push(default)  // in programs whose other names are hidden, too

extern "C" {

int maploop_portable_math = 1;  // the linker is asked for this name (CMakeLists.txt)

MAPLOOP_ONE_ARGUMENT(sin)
MAPLOOP_ONE_ARGUMENT(cos)
MAPLOOP_ONE_ARGUMENT(tan)
MAPLOOP_ONE_ARGUMENT(asin)
MAPLOOP_ONE_ARGUMENT(acos)
MAPLOOP_ONE_ARGUMENT(atan)
MAPLOOP_TWO_ARGUMENTS(atan2)
MAPLOOP_ONE_ARGUMENT(sinh)
MAPLOOP_ONE_ARGUMENT(cosh)
MAPLOOP_ONE_ARGUMENT(tanh)
MAPLOOP_ONE_ARGUMENT(asinh)
MAPLOOP_ONE_ARGUMENT(acosh)
MAPLOOP_ONE_ARGUMENT(atanh)
MAPLOOP_ONE_ARGUMENT(exp)
MAPLOOP_ONE_ARGUMENT(exp2)
MAPLOOP_ONE_ARGUMENT(exp10)
MAPLOOP_ONE_ARGUMENT(expm1)
MAPLOOP_ONE_ARGUMENT(log)
MAPLOOP_ONE_ARGUMENT(log2)
MAPLOOP_ONE_ARGUMENT(log10)
MAPLOOP_ONE_ARGUMENT(log1p)
MAPLOOP_TWO_ARGUMENTS(pow)

void sincos(double x, double* sine, double* cosine) {
  *sine = sin(x);
  *cosine = cos(x);
}
void sincosf(float x, float* sine, float* cosine) {
  *sine = sinf(x);
  *cosine = cosf(x);
}

}  // extern "C"

#pragma GCC visibility pop
