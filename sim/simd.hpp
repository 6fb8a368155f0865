#pragma once

// Pixel loops are compiled for AVX2 as well and the processor chooses. Both give the same bytes:
// the arithmetic is IEEE single precision, pixel by pixel, without contraction.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define VIGIA_PIXEL_LOOP __attribute__((target_clones("avx2", "default")))
#else
#define VIGIA_PIXEL_LOOP
#endif

// The body of pixel loops that differ in a constant: compiled into each of them.
#define VIGIA_PIXEL_BODY inline __attribute__((always_inline))
