#include "tests/support/counted_allocations.h"

#include <dlfcn.h>
#include <execinfo.h>
#include <malloc.h>
#include <pthread.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>

#include "tests/support/process.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define MAPLOOP_COUNTS_ALLOCATIONS 0
#else
#define MAPLOOP_COUNTS_ALLOCATIONS 1
#endif

namespace {

constexpr int most_frames = 24;
constexpr std::size_t most_threads = 128, most_places = 256;

// The way to one place that allocates.
struct Place {
  std::array<void*, most_frames> frames;
  int depth = 0;
  long count = 0;
};

// Contains what one thread allocates. Only that thread writes it, and it lies in static memory, so
// that writing it allocates nothing.
struct Watched {
  std::array<char, 16> name;
  long count = 0;
  std::array<Place, most_places> places;
  std::size_t places_used = 0;

  void note() {
    Place here;
    here.depth = backtrace(here.frames.data(), most_frames);
    ++count;
    Place* const end = places.data() + places_used;
    Place* const known = std::find_if(places.data(), end, [&](const Place& place) {
      return place.depth == here.depth &&
             std::equal(here.frames.begin(), here.frames.begin() + here.depth,
                        place.frames.begin());
    });
    if (known != end) {
      ++known->count;
    } else if (places_used < most_places) {
      places[places_used] = here;
      places[places_used++].count = 1;
    }
  }
};

std::array<Watched, most_threads> threads;
std::atomic<std::size_t> threads_used{0};
std::atomic<bool> watching{false};
std::atomic<long> bytes_held{0};
constinit thread_local long allocations = 0;
constinit thread_local Watched* own = nullptr;
constinit thread_local bool noting = false;

[[maybe_unused]] void count_one() {
  ++allocations;
  if (!watching.load(std::memory_order_relaxed) || noting) return;
  noting = true;  // what the note itself allocates is not counted
  if (own == nullptr) {
    const std::size_t k = threads_used.fetch_add(1);
    if (k < most_threads) {
      own = &threads[k];
      pthread_getname_np(pthread_self(), own->name.data(), own->name.size());
    }
  }
  if (own != nullptr) own->note();
  noting = false;
}

[[maybe_unused]] void* held(void* memory) {
  bytes_held.fetch_add(static_cast<long>(malloc_usable_size(memory)), std::memory_order_relaxed);
  return memory;
}

}  // namespace

#if MAPLOOP_COUNTS_ALLOCATIONS
// These are glibc's own entry points, which the replacements below call.
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* memory);
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

void* malloc(std::size_t size) {
  count_one();
  return held(__libc_malloc(size));
}
void* calloc(std::size_t count, std::size_t size) {
  count_one();
  return held(__libc_calloc(count, size));
}
void* realloc(void* memory, std::size_t size) {
  count_one();
  const auto before = static_cast<long>(malloc_usable_size(memory));
  void* const now = __libc_realloc(memory, size);
  if (now != nullptr || size == 0) bytes_held.fetch_sub(before, std::memory_order_relaxed);
  return held(now);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count_one();
  return held(__libc_memalign(alignment, size));
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  count_one();
  *memory = held(__libc_memalign(alignment, size));
  return *memory != nullptr ? 0 : ENOMEM;
}
void free(void* memory) {
  bytes_held.fetch_sub(static_cast<long>(malloc_usable_size(memory)), std::memory_order_relaxed);
  __libc_free(memory);
}
}
#endif

namespace maploop::testing {
namespace {

// Returns the functions of this program among the frames, innermost first, joined by " < ", or
// "another library".
std::string functions(const Place& place) {
  const std::set<std::string> allocators{"malloc", "calloc", "realloc", "aligned_alloc"};
  Dl_info self{}, info{};
  dladdr(reinterpret_cast<void*>(&functions), &self);
  std::vector<std::string> command{"addr2line", "-Cfse",
                                   std::filesystem::read_symlink("/proc/self/exe").string()};
  for (int i = 0; i < place.depth; ++i) {
    void* frame = place.frames[static_cast<std::size_t>(i)];
    if (dladdr(frame, &info) == 0 || info.dli_fbase != self.dli_fbase) continue;
    std::ostringstream offset;
    offset << std::hex
           << reinterpret_cast<std::uintptr_t>(frame) -
                  reinterpret_cast<std::uintptr_t>(self.dli_fbase) - 1;
    command.push_back(offset.str());
  }
  std::istringstream lines(run(command).out);
  std::string joined, function, file;
  while (std::getline(lines, function) && std::getline(lines, file)) {
    if (allocators.contains(function)) {
      joined.clear();  // so far they were the watch's own
      continue;
    }
    if (!joined.empty()) joined += " < ";
    joined += function.substr(0, function.find('('));
  }
  return joined.empty() ? "another library" : joined;
}

}  // namespace

bool counts_allocations() {
  return MAPLOOP_COUNTS_ALLOCATIONS;
}

long thread_allocations() {
  return allocations;
}

long held_bytes() {
  return bytes_held.load();
}

void watch_allocations() {
  std::array<void*, 1> frames{};
  backtrace(frames.data(), 1);  // loads what it needs
  for (std::size_t k = 0; k < std::min(threads_used.load(), most_threads); ++k) {
    threads[k].count = 0;
    threads[k].places_used = 0;
  }
  watching.store(true);
}

void unwatch_allocations() {
  watching.store(false);
}

std::vector<WatchedThread> watched_allocations() {
  constexpr std::size_t shown = 3;
  std::vector<WatchedThread> all;
  for (std::size_t k = 0; k < std::min(threads_used.load(), most_threads); ++k) {
    Watched& watched = threads[k];
    if (watched.count == 0) continue;
    WatchedThread& thread = all.emplace_back();
    thread.name = watched.name.data();
    thread.allocations = watched.count;
    std::vector<Place> places(
        watched.places.begin(),
        watched.places.begin() + static_cast<std::ptrdiff_t>(watched.places_used));
    std::sort(places.begin(), places.end(),
              [](const Place& a, const Place& b) { return a.count > b.count; });
    for (std::size_t i = 0; i < std::min(places.size(), shown); ++i)
      thread.callers.push_back(std::to_string(places[i].count) + " by " + functions(places[i]));
  }
  return all;
}

}  // namespace maploop::testing
