// Counts the allocations of each thread by malloc and everything that calls it, Eigen included. It
// replaces malloc, and so is for an executable of its own, which links maploop_counted_allocations.
#pragma once

namespace maploop::testing {

// Returns false if a sanitizer replaces malloc.
bool counts_allocations();

// Returns the number of allocations of the calling thread since it started.
long thread_allocations();

}  // namespace maploop::testing
