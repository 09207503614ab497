#include "tests/support/counted_allocations.h"

#include <cstdlib>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define MAPLOOP_COUNTS_ALLOCATIONS 0
#else
#define MAPLOOP_COUNTS_ALLOCATIONS 1
#endif

namespace {
constinit thread_local long allocations = 0;
}

#if MAPLOOP_COUNTS_ALLOCATIONS
// These are glibc's own entry points, which the replacements below call.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  ++allocations;
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
}
#endif

namespace maploop::testing {

bool counts_allocations() {
  return MAPLOOP_COUNTS_ALLOCATIONS;
}

long thread_allocations() {
  return allocations;
}

}  // namespace maploop::testing
