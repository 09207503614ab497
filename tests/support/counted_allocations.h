// Counts what each thread allocates, by malloc and all that goes through it, Eigen included. For an
// executable of its own, which links maploop_counted_allocations: it replaces malloc.
#pragma once

namespace maploop::testing {

// False where a sanitizer owns malloc.
bool counts_allocations();

// Of the calling thread, since it started.
long thread_allocations();

}  // namespace maploop::testing
