// Included before each source of Manifold: it asks malloc for its arrays and, but for its debug builds, does not look
// whether there are any. Where the memory is used up, std::bad_alloc says so instead of a crash.
#pragma once

#include <malloc.h>
#include <stdlib.h>

#include <cstdlib>
#include <new>

namespace vantage_mended {

inline void* checked_malloc(std::size_t size) {
  void* const memory = std::malloc(size);
  if (memory == nullptr && size > 0) throw std::bad_alloc();
  return memory;
}

}  // namespace vantage_mended

#define malloc(size) ::vantage_mended::checked_malloc(size)
