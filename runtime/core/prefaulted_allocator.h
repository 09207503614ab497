// This file defines an allocator whose memory is mapped before use, so the first lap of a ring
// causes no page fault.
#pragma once

#include <algorithm>
#include <cstddef>
#include <new>

#include "runtime/core/cache_line.h"

namespace maploop::runtime {

// Use it for std::vector and similar containers, each allocated once. Memory starts apart from any
// other data (no_sharing) and every page of it has been written when allocate() returns. Throws
// std::bad_alloc (std::bad_array_new_length if the size itself overflows).
template <typename T>
struct PrefaultedAllocator {
  using value_type = T;

  PrefaultedAllocator() = default;
  template <typename U>
  PrefaultedAllocator(const PrefaultedAllocator<U>&) {}

  T* allocate(std::size_t n) {
    if (n > (static_cast<std::size_t>(-1) - no_sharing) / sizeof(T)) {
      throw std::bad_array_new_length();
    }
    // The size is rounded up to whole units, so that the heap's next data are apart as well.
    const std::size_t bytes = (n * sizeof(T) + no_sharing - 1) / no_sharing * no_sharing;
    void* memory = ::operator new(bytes, item_alignment);
    for (std::size_t i = 0; i < bytes; i += smallest_page) {
      // The write is volatile because the compiler may otherwise drop it, as it precedes the
      // object's lifetime.
      static_cast<volatile std::byte*>(memory)[i] = std::byte{0};
    }
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, item_alignment); }

  friend bool operator==(PrefaultedAllocator, PrefaultedAllocator) { return true; }

 private:
  static constexpr std::size_t smallest_page = 4096;
  static constexpr std::align_val_t item_alignment{std::max(no_sharing, alignof(T))};
};

}  // namespace maploop::runtime
