// Allocator whose memory is mapped before it is used: no page fault on the first lap of a ring.
#pragma once

#include <algorithm>
#include <cstddef>
#include <new>

#include "runtime/core/cache_line.h"

namespace maploop::runtime {

// For std::vector and the like, each allocated once. Memory starts apart from any other data
// (kNoSharing) and every page of it has been written when allocate() returns. Throws std::bad_alloc
// (std::bad_array_new_length where the size itself overflows).
template <typename T>
struct PrefaultedAllocator {
  using value_type = T;

  PrefaultedAllocator() = default;
  template <typename U>
  PrefaultedAllocator(const PrefaultedAllocator<U>&) {}

  T* allocate(std::size_t n) {
    if (n > (static_cast<std::size_t>(-1) - kNoSharing) / sizeof(T)) {
      throw std::bad_array_new_length();
    }
    // Whole units, so that what the heap places behind is apart as well.
    const std::size_t bytes = (n * sizeof(T) + kNoSharing - 1) / kNoSharing * kNoSharing;
    void* memory = ::operator new(bytes, kAlignment);
    for (std::size_t i = 0; i < bytes; i += kSmallestPage) {
      // Volatile: the compiler may otherwise drop a write that comes before the object's life.
      static_cast<volatile std::byte*>(memory)[i] = std::byte{0};
    }
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, kAlignment); }

  friend bool operator==(PrefaultedAllocator, PrefaultedAllocator) { return true; }

 private:
  static constexpr std::size_t kSmallestPage = 4096;
  static constexpr std::align_val_t kAlignment{std::max(kNoSharing, alignof(T))};
};

}  // namespace maploop::runtime
