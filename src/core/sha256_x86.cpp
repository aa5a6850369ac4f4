// The SHA extensions of x86 (Intel, "Intel SHA Extensions", 2013): four words of the message in one register, two
// rounds to an instruction.
#include "core/sha256.h"

#if defined(__x86_64__) && defined(__GNUC__)

#include <cpuid.h>
#include <immintrin.h>

namespace vantage::internal::core {
namespace {

bool has_instructions() {
  unsigned a = 0, b = 0, c = 0, d = 0;
  if (!__get_cpuid(1, &a, &b, &c, &d) || !(c & bit_SSSE3) || !(c & bit_SSE4_1)) return false;
  return __get_cpuid_count(7, 0, &a, &b, &c, &d) && (b & bit_SHA);
}

__m128i load(const void* from) { return _mm_loadu_si128(static_cast<const __m128i*>(from)); }

__attribute__((target("sha,ssse3,sse4.1"))) void take_blocks(Sha256State& state, const char* bytes,
                                                             std::size_t blocks) {
  const __m128i big_endian = _mm_set_epi64x(0x0c0d0e0f08090a0b, 0x0405060700010203);
  // The instructions want the words as a, b, e, f and c, d, g, h, from the highest.
  const __m128i badc = _mm_shuffle_epi32(load(state.data()), 0xb1);
  const __m128i hgfe = _mm_shuffle_epi32(load(state.data() + 4), 0x1b);
  __m128i abef = _mm_alignr_epi8(badc, hgfe, 8), cdgh = _mm_blend_epi16(hgfe, badc, 0xf0);
  for (; blocks > 0; --blocks, bytes += 64) {
    const __m128i old_abef = abef, old_cdgh = cdgh;
    __m128i words[4];  // the last sixteen of the message schedule, in a ring
    for (int i = 0; i < 16; ++i) {
      __m128i& w = words[i % 4];
      if (i < 4) {
        w = _mm_shuffle_epi8(load(bytes + 16 * i), big_endian);
      } else {
        const __m128i &w4 = words[(i + 1) % 4], &w8 = words[(i + 2) % 4], &w12 = words[(i + 3) % 4];
        const __m128i sum = _mm_add_epi32(_mm_sha256msg1_epu32(w, w4), _mm_alignr_epi8(w12, w8, 4));
        w = _mm_sha256msg2_epu32(sum, w12);
      }
      const __m128i added = _mm_add_epi32(w, load(kSha256Constants.data() + 4 * i));
      cdgh = _mm_sha256rnds2_epu32(cdgh, abef, added);
      abef = _mm_sha256rnds2_epu32(abef, cdgh, _mm_shuffle_epi32(added, 0x0e));
    }
    abef = _mm_add_epi32(abef, old_abef);
    cdgh = _mm_add_epi32(cdgh, old_cdgh);
  }
  const __m128i feba = _mm_shuffle_epi32(abef, 0x1b), dchg = _mm_shuffle_epi32(cdgh, 0xb1);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(state.data()), _mm_blend_epi16(feba, dchg, 0xf0));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(state.data() + 4), _mm_alignr_epi8(dchg, feba, 8));
}

}  // namespace

bool sha256_blocks_by_processor(Sha256State& state, const char* bytes, std::size_t blocks) {
  static const bool is_possible = has_instructions();
  if (is_possible) take_blocks(state, bytes, blocks);
  return is_possible;
}

}  // namespace vantage::internal::core

#else

namespace vantage::internal::core {

bool sha256_blocks_by_processor(Sha256State&, const char*, std::size_t) { return false; }

}  // namespace vantage::internal::core

#endif
