#pragma once

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace vigia::tracking {

/// The last column of the run of pixels darker than @p threshold that goes right from @p u, where
/// the row's pixels up to @p last may be read.
inline int dark_run_end(const unsigned char* row, int u, int last, int threshold) {
#ifdef __SSE2__
  const __m128i limit = _mm_set1_epi8(static_cast<char>(threshold - 1));
  for (; u + 16 <= last; u += 16) {
    const __m128i pixels = _mm_loadu_si128(reinterpret_cast<const __m128i*>(row + u + 1));
    const int dark = _mm_movemask_epi8(_mm_cmpeq_epi8(_mm_min_epu8(pixels, limit), pixels));
    if (dark != 0xffff) return u + __builtin_ctz(static_cast<unsigned>(~dark));
  }
#endif
  while (u < last && row[u + 1] < threshold) ++u;
  return u;
}

/// The same to the left, down to @p first.
inline int dark_run_begin(const unsigned char* row, int u, int first, int threshold) {
#ifdef __SSE2__
  const __m128i limit = _mm_set1_epi8(static_cast<char>(threshold - 1));
  for (; u - 16 >= first; u -= 16) {
    const __m128i pixels = _mm_loadu_si128(reinterpret_cast<const __m128i*>(row + u - 16));
    const int dark = _mm_movemask_epi8(_mm_cmpeq_epi8(_mm_min_epu8(pixels, limit), pixels));
    if (dark != 0xffff) return u - __builtin_clz(static_cast<unsigned>(~dark & 0xffff) << 16U);
  }
#endif
  while (u > first && row[u - 1] < threshold) --u;
  return u;
}

}  // namespace vigia::tracking
