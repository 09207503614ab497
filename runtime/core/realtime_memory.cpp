#include "runtime/core/realtime_memory.h"

#include <alloca.h>
#include <malloc.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "runtime/core/realtime_text.h"

namespace maploop::runtime {
namespace {

constexpr std::size_t kilobyte = 1024;
constexpr std::size_t megabyte = 1024 * kilobyte;

std::size_t page_size() {
  return static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

std::string kilobytes(std::size_t bytes) {
  return std::to_string(bytes / kilobyte) + " kB";
}

// Writes each page from the high end down, as a stack grows. The write is volatile because the
// values are never read.
void touch(std::byte* memory, std::size_t bytes) {
  const std::size_t page = page_size();
  for (std::size_t end = bytes; end > 0; end -= std::min(page, end)) {
    static_cast<volatile std::byte*>(memory)[end - 1] = std::byte{0};
  }
}

// Returns how many bytes of the range are in memory now, in whole pages.
std::size_t resident(std::byte* memory, std::size_t bytes) {
  const std::size_t page = page_size();
  const std::size_t misaligned = reinterpret_cast<std::uintptr_t>(memory) % page;
  const std::size_t skipped = misaligned == 0 ? 0 : page - misaligned;
  if (bytes < skipped + page) return 0;
  std::vector<unsigned char> pages((bytes - skipped) / page);
  if (mincore(memory + skipped, pages.size() * page, pages.data()) != 0) return 0;
  const auto there = std::count_if(pages.begin(), pages.end(), [](auto p) { return (p & 1) != 0; });
  return static_cast<std::size_t>(there) * page;
}

// Returns how much of the calling thread's stack lies below this function's frame; 0 if unknown.
std::size_t stack_left() {
  pthread_attr_t attributes;
  if (pthread_getattr_np(pthread_self(), &attributes) != 0) return 0;
  void* lowest = nullptr;
  std::size_t size = 0;
  const int error = pthread_attr_getstack(&attributes, &lowest, &size);
  pthread_attr_destroy(&attributes);
  const auto here = reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0));
  const auto end = reinterpret_cast<std::uintptr_t>(lowest);
  return error == 0 && here > end && here - end <= size ? here - end : 0;
}

// This is not inlined, so that the return gives the memory back to the stack.
[[gnu::noinline]] std::size_t touch_stack(std::size_t bytes) {
  auto* memory = static_cast<std::byte*>(alloca(bytes));
  touch(memory, bytes);
  return resident(memory, bytes);
}

RealtimeSetting prepare_heap(int mb, int arenas) {
  const RealtimeRequest heap{"heap", std::to_string(mb) + " MB mapped and kept"};
  const bool tuned = mallopt(M_TRIM_THRESHOLD, -1) == 1 && mallopt(M_MMAP_MAX, 0) == 1 &&
                     mallopt(M_ARENA_MAX, arenas) == 1;
  const std::size_t bytes = static_cast<std::size_t>(mb) * megabyte;
  std::size_t mapped = 0;
  if (auto* memory = static_cast<std::byte*>(std::malloc(bytes))) {
    touch(memory, bytes);
    mapped = resident(memory, bytes);
    std::free(memory);
  }
  const std::size_t kept = std::min(mapped, static_cast<std::size_t>(mallinfo2().fordblks));
  const std::string text = std::to_string((kept + megabyte / 2) / megabyte) + " MB mapped and kept";
  // Less than a page at either end may be shared with other data.
  if (kept + 2 * page_size() >= bytes) return heap.granted(text);
  if (!tuned || mapped + 2 * page_size() >= bytes) {
    return heap.refused(text, "malloc is not glibc's, and gives freed memory back",
                        "start the program without the other malloc (LD_PRELOAD, sanitizer)");
  }
  return heap.refused(
      text, "there is not so much memory for this process",
      "lower heap_mb, or raise the limit (ulimit -v, the control group's memory.max)");
}

RealtimeSetting lock_memory(const Privileges& privileges) {
  const RealtimeRequest memory{"locked memory", "all, and what comes"};
  const bool unlimited = privileges.ipc_lock || privileges.memlock == Privileges::no_limit;
  int error = mlockall(MCL_CURRENT) == 0 ? 0 : errno;
  if (unlimited && error == 0) {
    error = mlockall(MCL_FUTURE | MCL_ONFAULT) == 0 ? 0 : errno;
  }
  const std::string status = read_system_file("/proc/self/status").value_or("");
  const std::int64_t locked = parse_integer(line_value(status, "VmLck").value_or("")).value_or(0);
  const std::string text = std::to_string(locked) + " kB of " +
                           std::string(line_value(status, "VmSize").value_or("unknown"));
  if (unlimited && error == 0 && locked > 0) return memory.granted(text);
  if (!unlimited) {
    return memory.refused(text,
                          "no CAP_IPC_LOCK, and RLIMIT_MEMLOCK is " +
                              kilobytes(privileges.memlock) +
                              (error == 0 ? ": what comes is not locked" : ""),
                          "add '@GROUP - memlock unlimited' to a file in /etc/security/limits.d "
                          "and log in again; or run as root");
  }
  if (error != 0) return memory.refused(text, std::strerror(error), "see mlockall(2)");
  return memory.refused(text, "the kernel accepted it and says otherwise",
                        "start the program without the sanitizer or tool that intercepts mlockall");
}

}  // namespace

std::vector<RealtimeSetting> prepare_memory(const MemoryParameters& parameters,
                                            const Privileges& privileges) {
  std::vector<RealtimeSetting> settings;
  if (parameters.heap_mb > 0) {
    settings.push_back(prepare_heap(parameters.heap_mb, parameters.malloc_arenas));
  }
  if (parameters.lock_memory) settings.push_back(lock_memory(privileges));
  return settings;
}

RealtimeSetting prefault_stack(const std::string& name, int kb) {
  // This remains for the functions and frames called meanwhile, and for signals.
  constexpr std::size_t kept_free = 64 * kilobyte;
  const RealtimeRequest stack{name + ": stack", std::to_string(kb) + " kB mapped"};
  const std::size_t asked = static_cast<std::size_t>(std::max(kb, 0)) * kilobyte;
  const std::size_t left = stack_left();
  const std::size_t bytes = std::min(asked, left > kept_free ? left - kept_free : 0);
  const std::size_t mapped = bytes > 0 ? touch_stack(bytes) : 0;
  // mincore counts whole pages, so the two at the ends may be missing.
  const std::size_t granted = mapped + 2 * page_size() >= bytes ? bytes : mapped;
  const std::string text = kilobytes(granted) + " mapped";
  if (granted == asked && kb >= 0) return stack.granted(text);
  return stack.refused(text,
                       kb < 0 ? "a size must not be negative"
                              : "the stack has " + kilobytes(left) + " left, of which " +
                                    kilobytes(kept_free) + " are kept free",
                       "lower prefaulted_stack_kb, or raise the stack limit (ulimit -s)");
}

}  // namespace maploop::runtime
