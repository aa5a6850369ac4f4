// Only in wheels. Debian's Expat takes random numbers from arc4random_buf, which is in glibc since 2.36: with this one
// instead, the wheel also fits systems with glibc 2.35 (Ubuntu 22.04).
#include <sys/random.h>

#include <cerrno>
#include <cstddef>
#include <cstdlib>

extern "C" __attribute__((visibility("hidden"))) void arc4random_buf(void* buffer, std::size_t size) {
  auto* to = static_cast<unsigned char*>(buffer);
  while (size > 0) {
    const ssize_t got = getrandom(to, size, 0);
    if (got < 0 && errno != EINTR) std::abort();  // as glibc does: there is no other source
    if (got <= 0) continue;
    to += got;
    size -= static_cast<std::size_t>(got);
  }
}
