// XXH3 as inlined functions, so that no program needs its library.
#pragma once

#define XXH_INLINE_ALL
#include <xxhash.h>
