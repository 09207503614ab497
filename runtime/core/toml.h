// toml++, compiled with what uses it, so that no program needs its library. A damaged file breaks
// some of its assertions before it is refused: they are off, as in the library.
#pragma once

#define TOML_ASSERT(expr) static_assert(true)
#include <toml++/toml.h>
