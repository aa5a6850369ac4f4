// Included before each source of Manifold: it asks malloc for its arrays and, but for its debug builds, does not look
// whether there are any. Where the memory is used up, std::bad_alloc says so instead of a crash.
#pragma once

// What declares these functions, before their names become others.
#include <stdlib.h>
#if __has_include(<malloc.h>)
#include <malloc.h>
#endif
#if __has_include(<sched.h>)
#include <sched.h>  // that of musl declares calloc
#endif

#include <cstdlib>
#include <new>

namespace vantage_mended {

inline void* checked(void* memory, std::size_t size) {
  if (memory == nullptr && size > 0) throw std::bad_alloc();
  return memory;
}
inline void* checked_malloc(std::size_t size) { return checked(std::malloc(size), size); }
inline void* checked_calloc(std::size_t count, std::size_t size) {
  return checked(std::calloc(count, size), count > 0 ? size : 0);
}
inline void* checked_realloc(void* memory, std::size_t size) { return checked(std::realloc(memory, size), size); }

}  // namespace vantage_mended

// Also after std::
namespace std {
using ::vantage_mended::checked_calloc;
using ::vantage_mended::checked_malloc;
using ::vantage_mended::checked_realloc;
}  // namespace std
using vantage_mended::checked_calloc;
using vantage_mended::checked_malloc;
using vantage_mended::checked_realloc;

#define calloc(count, size) checked_calloc(count, size)
#define malloc(size) checked_malloc(size)
#define realloc(memory, size) checked_realloc(memory, size)
