/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_tile_pixels.h"

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
load(const void *words)
{
   return _mm_loadu_si128((const __m128i *)words);
}


static inline void
store(void *pixels, __m128i value)
{
   _mm_storeu_si128((__m128i *)pixels, value);
}


static inline void
write_pixels(uint8_t *pixels, __m128i value, bool stream)
{
   if (stream)
      _mm_stream_si128((__m128i *)pixels, value);
   else
      store(pixels, value);
}


static void
load_32(uint32_t *words, const uint8_t *block, unsigned stride)
{
   for (unsigned y = 0; y < 4; y += 2) {
      const __m128i upper = load(block + y * stride);
      const __m128i lower = load(block + (y + 1) * stride);

      store(words + 4 * y, _mm_unpacklo_epi64(upper, lower));
      store(words + 4 * y + 4, _mm_unpackhi_epi64(upper, lower));
   }
}


static void
load_64(uint32_t *words, const uint8_t *block, unsigned stride)
{
   for (unsigned q = 0; q < 4; q++) {
      const uint8_t *pixels = block + q / 2 * 2 * stride + q % 2 * 16;
      const __m128i upper =
         _mm_shuffle_epi32(load(pixels), _MM_SHUFFLE(3, 1, 2, 0));
      const __m128i lower =
         _mm_shuffle_epi32(load(pixels + stride), _MM_SHUFFLE(3, 1, 2, 0));

      store(words + 4 * q, _mm_unpacklo_epi64(upper, lower));
      store(words + 4 * q + 16, _mm_unpackhi_epi64(upper, lower));
   }
}


static void
load_128(uint32_t *words, const uint8_t *block, unsigned stride)
{
   for (unsigned q = 0; q < 4; q++) {
      const uint8_t *pixels = block + q / 2 * 2 * stride + q % 2 * 32;
      const __m128i p[4] = {
         load(pixels), load(pixels + 16),
         load(pixels + stride), load(pixels + stride + 16)
      };
      __m128i w[4];

      transpose4_epi32(&p[0], &p[1], &p[2], &p[3], &w[0], &w[1], &w[2], &w[3]);
      for (unsigned i = 0; i < 4; i++)
         store(words + 4 * q + 16 * i, w[i]);
   }
}


static inline void
store_32(const uint32_t *const quads[4], uint8_t *block, unsigned stride,
         bool stream)
{
   for (unsigned y = 0; y < 4; y += 2) {
      const __m128i left = load(quads[y]);
      const __m128i right = load(quads[y + 1]);

      write_pixels(block + y * stride,
                   _mm_unpacklo_epi64(left, right), stream);
      write_pixels(block + (y + 1) * stride,
                   _mm_unpackhi_epi64(left, right), stream);
   }
}


static inline void
store_64(const uint32_t *const quads[4], uint8_t *block, unsigned stride,
         bool stream)
{
   for (unsigned q = 0; q < 4; q++) {
      uint8_t *pixels = block + q / 2 * 2 * stride + q % 2 * 16;
      const __m128i w0 = load(quads[q]);
      const __m128i w1 = load(quads[q] + 16);

      write_pixels(pixels, _mm_unpacklo_epi32(w0, w1), stream);
      write_pixels(pixels + stride, _mm_unpackhi_epi32(w0, w1), stream);
   }
}


static inline void
store_128(const uint32_t *const quads[4], uint8_t *block, unsigned stride,
          bool stream)
{
   for (unsigned q = 0; q < 4; q++) {
      uint8_t *pixels = block + q / 2 * 2 * stride + q % 2 * 32;
      __m128i w[4], p[4];

      for (unsigned i = 0; i < 4; i++)
         w[i] = load(quads[q] + 16 * i);
      transpose4_epi32(&w[0], &w[1], &w[2], &w[3], &p[0], &p[1], &p[2], &p[3]);
      write_pixels(pixels, p[0], stream);
      write_pixels(pixels + 16, p[1], stream);
      write_pixels(pixels + stride, p[2], stream);
      write_pixels(pixels + stride + 16, p[3], stream);
   }
}


void
lp_tile_stream_end(void)
{
   _mm_sfence();
}

#else

static void
load_32(uint32_t *words, const uint8_t *block, unsigned stride)
{
   load_any(words, block, stride, 4);
}


static void
load_64(uint32_t *words, const uint8_t *block, unsigned stride)
{
   load_any(words, block, stride, 8);
}


static void
load_128(uint32_t *words, const uint8_t *block, unsigned stride)
{
   load_any(words, block, stride, 16);
}


static void
store_32(const uint32_t *const quads[4], uint8_t *block, unsigned stride,
         bool stream)
{
   store_any(quads, block, stride, 4);
}


static void
store_64(const uint32_t *const quads[4], uint8_t *block, unsigned stride,
         bool stream)
{
   store_any(quads, block, stride, 8);
}


static void
store_128(const uint32_t *const quads[4], uint8_t *block, unsigned stride,
          bool stream)
{
   store_any(quads, block, stride, 16);
}


void
lp_tile_stream_end(void)
{
}

#endif


/* In what follows the sizes are constant for the sake of the loops. */

void
lp_tile_load_pixels(uint32_t *words, const uint8_t *block, unsigned stride,
                    unsigned bytes)
{
   switch (bytes) {
   case 1:
      load_any(words, block, stride, 1);
      break;
   case 2:
      load_any(words, block, stride, 2);
      break;
   case 4:
      load_32(words, block, stride);
      break;
   case 8:
      load_64(words, block, stride);
      break;
   case 12:
      load_any(words, block, stride, 12);
      break;
   case 16:
      load_128(words, block, stride);
      break;
   default:
      unreachable("pixel size of a buffer");
   }
}


void
lp_tile_fill_pixels(uint32_t *words, const uint32_t *value, unsigned bytes)
{
   for (unsigned w = 0; w < DIV_ROUND_UP(bytes, 4); w++) {
      uint32_t word = 0;

      memcpy(&word, &value[w], MIN2(bytes - 4 * w, 4));
      for (unsigned i = 0; i < 16; i++)
         words[16 * w + i] = word;
   }
}


void
lp_tile_store_pixels(const uint32_t *const quads[4], uint8_t *block,
                     unsigned stride, unsigned bytes, bool stream)
{
   if (((uintptr_t)block | stride) % 16)
      stream = false;

   switch (bytes) {
   case 1:
      store_any(quads, block, stride, 1);
      break;
   case 2:
      store_any(quads, block, stride, 2);
      break;
   case 4:
      if (stream)
         store_32(quads, block, stride, true);
      else
         store_32(quads, block, stride, false);
      break;
   case 8:
      if (stream)
         store_64(quads, block, stride, true);
      else
         store_64(quads, block, stride, false);
      break;
   case 12:
      store_any(quads, block, stride, 12);
      break;
   case 16:
      if (stream)
         store_128(quads, block, stride, true);
      else
         store_128(quads, block, stride, false);
      break;
   default:
      unreachable("pixel size of a buffer");
   }
}
