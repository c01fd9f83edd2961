/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_peel_pixels.h"

#include <string.h>

#include "util/macros.h"
#include "util/u_math.h"
#include "util/u_sse.h"


static inline void
load_any(uint32_t *words, const uint8_t *block, unsigned stride,
         unsigned bytes)
{
   for (unsigned i = 0; i < 16; i++) {
      const unsigned x = i / 4 % 2 * 2 + i % 2;
      const unsigned y = i / 8 * 2 + i % 4 / 2;
      const uint8_t *pixel = block + y * stride + x * bytes;

      for (unsigned w = 0; w < DIV_ROUND_UP(bytes, 4); w++) {
         uint32_t word = 0;

         memcpy(&word, pixel + 4 * w, MIN2(bytes - 4 * w, 4));
         words[16 * w + i] = word;
      }
   }
}


static inline void
store_any(const uint32_t *const quads[4], uint8_t *block, unsigned stride,
          unsigned bytes)
{
   for (unsigned i = 0; i < 16; i++) {
      const unsigned x = i / 4 % 2 * 2 + i % 2;
      const unsigned y = i / 8 * 2 + i % 4 / 2;
      uint8_t *pixel = block + y * stride + x * bytes;

      for (unsigned w = 0; w < DIV_ROUND_UP(bytes, 4); w++) {
         memcpy(pixel + 4 * w, &quads[i / 4][16 * w + i % 4],
                MIN2(bytes - 4 * w, 4));
      }
   }
}


#if DETECT_ARCH_SSE

static inline __m128i
load(const uint32_t *words)
{
   return _mm_loadu_si128((const __m128i *)words);
}


static inline void
store(uint8_t *pixels, __m128i value)
{
   _mm_storeu_si128((__m128i *)pixels, value);
}


static void
store_32(const uint32_t *const quads[4], uint8_t *block, unsigned stride)
{
   for (unsigned y = 0; y < 4; y += 2) {
      const __m128i left = load(quads[y]);
      const __m128i right = load(quads[y + 1]);

      store(block + y * stride, _mm_unpacklo_epi64(left, right));
      store(block + (y + 1) * stride, _mm_unpackhi_epi64(left, right));
   }
}


static void
store_64(const uint32_t *const quads[4], uint8_t *block, unsigned stride)
{
   for (unsigned q = 0; q < 4; q++) {
      uint8_t *pixels = block + q / 2 * 2 * stride + q % 2 * 16;
      const __m128i w0 = load(quads[q]);
      const __m128i w1 = load(quads[q] + 16);

      store(pixels, _mm_unpacklo_epi32(w0, w1));
      store(pixels + stride, _mm_unpackhi_epi32(w0, w1));
   }
}


static void
store_128(const uint32_t *const quads[4], uint8_t *block, unsigned stride)
{
   for (unsigned q = 0; q < 4; q++) {
      uint8_t *pixels = block + q / 2 * 2 * stride + q % 2 * 32;
      __m128i w[4], p[4];

      for (unsigned i = 0; i < 4; i++)
         w[i] = load(quads[q] + 16 * i);
      transpose4_epi32(&w[0], &w[1], &w[2], &w[3], &p[0], &p[1], &p[2], &p[3]);
      store(pixels, p[0]);
      store(pixels + 16, p[1]);
      store(pixels + stride, p[2]);
      store(pixels + stride + 16, p[3]);
   }
}

#else

static void
store_32(const uint32_t *const quads[4], uint8_t *block, unsigned stride)
{
   store_any(quads, block, stride, 4);
}


static void
store_64(const uint32_t *const quads[4], uint8_t *block, unsigned stride)
{
   store_any(quads, block, stride, 8);
}


static void
store_128(const uint32_t *const quads[4], uint8_t *block, unsigned stride)
{
   store_any(quads, block, stride, 16);
}

#endif


void
lp_peel_load_pixels(uint32_t *words, const uint8_t *block, unsigned stride,
                    unsigned bytes)
{
   /* So that the loops know the size. */
   switch (bytes) {
   case 1:
      load_any(words, block, stride, 1);
      break;
   case 2:
      load_any(words, block, stride, 2);
      break;
   case 4:
      load_any(words, block, stride, 4);
      break;
   case 8:
      load_any(words, block, stride, 8);
      break;
   case 12:
      load_any(words, block, stride, 12);
      break;
   case 16:
      load_any(words, block, stride, 16);
      break;
   default:
      unreachable("pixel size of a buffer");
   }
}


void
lp_peel_store_pixels(const uint32_t *const quads[4], uint8_t *block,
                     unsigned stride, unsigned bytes)
{
   switch (bytes) {
   case 1:
      store_any(quads, block, stride, 1);
      break;
   case 2:
      store_any(quads, block, stride, 2);
      break;
   case 4:
      store_32(quads, block, stride);
      break;
   case 8:
      store_64(quads, block, stride);
      break;
   case 12:
      store_any(quads, block, stride, 12);
      break;
   case 16:
      store_128(quads, block, stride);
      break;
   default:
      unreachable("pixel size of a buffer");
   }
}
