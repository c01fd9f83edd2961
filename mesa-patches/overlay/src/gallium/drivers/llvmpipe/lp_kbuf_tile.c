/*
 * Copyright © 2026 The mesa-kbuffer authors
 * SPDX-License-Identifier: MIT
 */

#include "lp_kbuf_tile.h"

#include "util/format/u_format.h"
#include "util/u_memory.h"
#include "util/u_math.h"
#include "util/u_sse.h"

#include "lp_rast_priv.h"
#include "lp_scene.h"

/* Room for all entries with the largest pixels. */
#define TILE_DATA_SIZE \
   (LP_KBUF_TILE_BLOCKS * LP_MAX_KBUF_ENTRIES * 4 * LP_KBUF_WORD_SIZE)


void
lp_kbuf_layout_init(struct lp_kbuf_layout *layout, unsigned num_entries,
                    unsigned num_color_buffers,
                    const enum pipe_format *formats, unsigned num_formats)
{
   layout->size = 0;
   for (unsigned e = 0; e < num_entries; e++) {
      const unsigned cbuf = e % num_color_buffers;

      layout->offset[e] = layout->size;
      if (cbuf < num_formats && formats[cbuf] != PIPE_FORMAT_NONE) {
         layout->size +=
            DIV_ROUND_UP(util_format_get_blocksizebits(formats[cbuf]), 32);
      }
   }
}


/** The first pixel of a quad of a block. */
static inline uint8_t *
quad_pixels(uint8_t *block, unsigned stride, unsigned bytes, unsigned quad)
{
   return block + quad / 2 * 2 * stride + quad % 2 * 2 * bytes;
}


static inline void
load_pixels(uint32_t *words, uint8_t *block, unsigned stride, unsigned bytes)
{
   for (unsigned i = 0; i < 16; i++) {
      const uint8_t *pixel = quad_pixels(block, stride, bytes, i / 4) +
                             i % 4 / 2 * stride + i % 2 * bytes;

      for (unsigned w = 0; w < DIV_ROUND_UP(bytes, 4); w++) {
         uint32_t word = 0;

         memcpy(&word, pixel + 4 * w, MIN2(bytes - 4 * w, 4));
         words[16 * w + i] = word;
      }
   }
}


static inline void
store_pixels(const uint32_t *words, uint8_t *block, unsigned stride,
             unsigned bytes)
{
   for (unsigned i = 0; i < 16; i++) {
      uint8_t *pixel = quad_pixels(block, stride, bytes, i / 4) +
                       i % 4 / 2 * stride + i % 2 * bytes;

      for (unsigned w = 0; w < DIV_ROUND_UP(bytes, 4); w++)
         memcpy(pixel + 4 * w, &words[16 * w + i], MIN2(bytes - 4 * w, 4));
   }
}


#if DETECT_ARCH_SSE

static void
load_pixels_128(uint32_t *words, uint8_t *block, unsigned stride)
{
   for (unsigned quad = 0; quad < 4; quad++) {
      uint8_t *pixels = quad_pixels(block, stride, 16, quad);
      const __m128i p0 = _mm_loadu_si128((const __m128i *)pixels);
      const __m128i p1 = _mm_loadu_si128((const __m128i *)(pixels + 16));
      const __m128i p2 = _mm_loadu_si128((const __m128i *)(pixels + stride));
      const __m128i p3 = _mm_loadu_si128((const __m128i *)(pixels + stride + 16));
      __m128i *dst = (__m128i *)words + quad;

      transpose4_epi32(&p0, &p1, &p2, &p3, &dst[0], &dst[4], &dst[8], &dst[12]);
   }
}

static void
store_pixels_128(const uint32_t *words, uint8_t *block, unsigned stride)
{
   for (unsigned quad = 0; quad < 4; quad++) {
      uint8_t *pixels = quad_pixels(block, stride, 16, quad);
      const __m128i *src = (const __m128i *)words + quad;
      __m128i p0, p1, p2, p3;

      transpose4_epi32(&src[0], &src[4], &src[8], &src[12], &p0, &p1, &p2, &p3);
      _mm_storeu_si128((__m128i *)pixels, p0);
      _mm_storeu_si128((__m128i *)(pixels + 16), p1);
      _mm_storeu_si128((__m128i *)(pixels + stride), p2);
      _mm_storeu_si128((__m128i *)(pixels + stride + 16), p3);
   }
}

#else

static void
load_pixels_128(uint32_t *words, uint8_t *block, unsigned stride)
{
   load_pixels(words, block, stride, 16);
}

static void
store_pixels_128(const uint32_t *words, uint8_t *block, unsigned stride)
{
   store_pixels(words, block, stride, 16);
}

#endif


/** Copy a block of one entry in (or out), with the pixel size constant. */
static void
copy_block(uint32_t *words, uint8_t *block, unsigned stride, unsigned bytes,
           bool in)
{
   switch (bytes) {
#define CASE(n) \
   case n: \
      if (in) \
         load_pixels(words, block, stride, n); \
      else \
         store_pixels(words, block, stride, n); \
      break
   CASE(1);
   CASE(2);
   CASE(4);
   CASE(8);
   CASE(12);
#undef CASE
   case 16:
      if (in)
         load_pixels_128(words, block, stride);
      else
         store_pixels_128(words, block, stride);
      break;
   default:
      unreachable("pixel size of a color buffer");
   }
}


static void
copy_entries(struct lp_kbuf_tile *tile, unsigned block, uint64_t entries,
             bool in)
{
   const struct lp_rasterizer_task *task = tile->task;
   const struct lp_scene *scene = task->scene;
   const struct lp_jit_kbuf *kbuf = tile->kbuf;
   const unsigned x = block % (TILE_SIZE / 4) * 4;
   const unsigned y = block / (TILE_SIZE / 4) * 4;
   uint8_t *words = tile->data + block * kbuf->block_size;

   for (unsigned e = 0; e < kbuf->num_entries; e++) {
      const unsigned cbuf = e % kbuf->num_color_buffers;

      if (cbuf >= scene->fb.nr_cbufs || !scene->fb.cbufs[cbuf])
         continue;

      const unsigned stride = scene->cbufs[cbuf].stride;
      const unsigned bytes = scene->cbufs[cbuf].format_bytes;

      if (entries & BITFIELD64_BIT(e)) {
         copy_block((uint32_t *)words,
                    task->color_tiles[cbuf] +
                    e / kbuf->num_color_buffers * kbuf->layer_stride[cbuf] +
                    y * stride + x * bytes,
                    stride, bytes, in);
      }
      words += DIV_ROUND_UP(bytes, 4) * LP_KBUF_WORD_SIZE;
   }
}


static void
load_block(struct lp_kbuf_tile *tile, uint32_t block)
{
   copy_entries(tile, block, ~UINT64_C(0), true);
   tile->valid[block] = true;
}


void
lp_kbuf_tile_flush(struct lp_kbuf_tile *tile)
{
   for (unsigned block = 0; block < LP_KBUF_TILE_BLOCKS; block++) {
      if (tile->valid[block])
         copy_entries(tile, block, tile->written, false);
   }
   memset(tile->valid, 0, sizeof tile->valid);
   tile->written = tile->kbuf->written;
}


void
lp_kbuf_tile_set_state(struct lp_rasterizer_task *task)
{
   struct lp_kbuf_tile *tile = task->thread_data.kbuf_tile;
   const struct lp_jit_kbuf *kbuf = task->state->kbuf;

   if (kbuf && !kbuf->tiled)
      kbuf = NULL;

   if (tile->kbuf &&
       (!kbuf || kbuf->num_entries != tile->kbuf->num_entries ||
        kbuf->num_color_buffers != tile->kbuf->num_color_buffers))
      lp_kbuf_tile_end(tile);

   if (kbuf) {
      tile->kbuf = kbuf;
      tile->written |= kbuf->written;
   }
}


bool
lp_kbuf_tiles_create(struct lp_rasterizer *rast)
{
   for (unsigned i = 0; i < MAX2(1, rast->num_threads); i++) {
      struct lp_rasterizer_task *task = &rast->tasks[i];

      if (task->thread_data.kbuf_tile)
         continue;

      struct lp_kbuf_tile *tile = CALLOC_STRUCT(lp_kbuf_tile);
      if (!tile)
         return false;

      tile->data = align_malloc(TILE_DATA_SIZE, 64);
      if (!tile->data) {
         FREE(tile);
         return false;
      }
      tile->load_block = load_block;
      tile->task = task;
      task->thread_data.kbuf_tile = tile;
   }
   return true;
}


void
lp_kbuf_tiles_destroy(struct lp_rasterizer *rast)
{
   for (unsigned i = 0; i < MAX2(1, rast->num_threads); i++) {
      struct lp_kbuf_tile *tile = rast->tasks[i].thread_data.kbuf_tile;

      if (tile) {
         align_free(tile->data);
         FREE(tile);
      }
   }
}
