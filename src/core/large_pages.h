// Memory for numbers that are read all over: in few large pages where the system has them, or a page of 4 KiB
// would be looked up for almost every read.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

namespace hemibake {

template <class T>
struct LargePageAllocator {
  using value_type = T;
  static constexpr size_t kLargePage = size_t{2} << 20;

  LargePageAllocator() = default;
  template <class Other>
  LargePageAllocator(const LargePageAllocator<Other>&) {}

  // Less than a large page comes from where all memory does.
  T* allocate(size_t count) {
    const size_t wanted = count * sizeof(T);
    const size_t bytes = wanted < kLargePage ? wanted : (wanted + kLargePage - 1) / kLargePage * kLargePage;
    void* memory = bytes < kLargePage ? std::malloc(bytes) : std::aligned_alloc(kLargePage, bytes);
    if (!memory) throw std::bad_alloc();
    if (bytes >= kLargePage) madvise(memory, bytes, MADV_HUGEPAGE);  // a wish: its failure changes nothing
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, size_t) { std::free(memory); }

  // Leaves new elements unset: they are written before they are read.
  template <class U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Values>
  void construct(U* place, Values&&... values) {
    ::new (static_cast<void*>(place)) U(std::forward<Values>(values)...);
  }

  template <class Other>
  bool operator==(const LargePageAllocator<Other>&) const {
    return true;
  }
};

template <class T>
using LargePageVector = std::vector<T, LargePageAllocator<T>>;

}  // namespace hemibake
