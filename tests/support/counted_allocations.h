// Counts the allocations of each thread by malloc and everything that calls it, Eigen included. It
// replaces malloc, and so is for an executable of its own, which links maploop_counted_allocations.
#pragma once

#include <string>
#include <vector>

namespace maploop::testing {

// Returns false if a sanitizer replaces malloc.
bool counts_allocations();

// Returns the number of allocations of the calling thread since it started.
long thread_allocations();

// Returns the bytes that all threads have allocated and not freed.
long held_bytes();

// Between the two calls, each allocation of any thread is counted with the functions that led to
// it, which slows the allocating thread. Threads may start and end meanwhile. What was counted
// before is forgotten.
void watch_allocations();
void unwatch_allocations();

struct WatchedThread {
  std::string name;  // as pthread_setname_np() has set it
  long allocations = 0;
  // The functions of this program that led to the most frequent ones, with their number. What the
  // compiler has inlined is named as its caller.
  std::vector<std::string> callers;
};
// Returns one entry for each thread that has allocated while it was watched.
std::vector<WatchedThread> watched_allocations();

}  // namespace maploop::testing
