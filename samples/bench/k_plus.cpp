// SPDX-License-Identifier: MIT
//
// The k+-buffer (Vasilakis and Fudos 2014) in one pass: a fragment that is nearer than the farthest
// of its pixel's k takes the pixel's lock and then the farthest's place; the resolve sorts. With
// culling, fragments that are too far do not take the lock.
//
// As the paper has it, but for what is faster in llvmpipe:
// - The word of the lock holds the number of fragments and, when the pixel is full, the place of
//   the farthest, which so need not be moved to the first slot; its depth has a buffer of its own,
//   which holds a depth behind all until the pixel is full.
// - For k above 16 the paper has a max-heap. Here a slot's block of eight has its maximum stored,
//   so that finding the farthest anew takes one look at a block and one at the maxima: 16 loads for
//   k = 64 instead of the max-array's 64, and none of the heap's moves.

#include "bench/renderer.hpp"
#include "bench/sorting_network.hpp"
#include "bench/storage_buffer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace kb::bench
{

namespace
{

/// The largest k for which all depths are looked at.
constexpr int max_flat_k = 16;
constexpr int slots_in_block = 8;

/// Behind every depth in the window.
constexpr float behind_all = 2.0F;

int slot_blocks(int k)
{
    return k <= max_flat_k ? 0 : (k + slots_in_block - 1) / slots_in_block;
}

std::string declarations(Size size, int k)
{
    return pixel_order_glsl(size) + fmt::format(R"(
layout(std430, binding = 0) coherent buffer States {{ uint states[]; }};
layout(std430, binding = 1) coherent writeonly buffer Limits {{ float limits[]; }};
layout(std430, binding = 2) coherent writeonly buffer Depths {{ float depths[]; }};
layout(std430, binding = 3) coherent buffer Colors {{ uint colors[]; }};
layout(std430, binding = 4) coherent writeonly buffer Maxima {{ float maxima[]; }};
layout(binding = 0, r32f) coherent readonly uniform imageBuffer limit_texels;
layout(binding = 1, r32f) coherent readonly uniform imageBuffer depth_texels;
layout(binding = 2, r32f) coherent readonly uniform imageBuffer maximum_texels;

const int stride = {block_pixels}; // Slots of a pixel, and maxima, are this far apart.
const int k = {k};
int state_of_pixel = block_of_pixel() * stride + place_in_block();
int first_slot = block_of_pixel() * stride * k + place_in_block();
int first_maximum = block_of_pixel() * stride * {maxima} + place_in_block();

float limit()
{{
    return imageLoad(limit_texels, state_of_pixel).r;
}}

float depth(int slot)
{{
    return imageLoad(depth_texels, first_slot + slot * stride).r;
}}

float maximum(int block)
{{
    return imageLoad(maximum_texels, first_maximum + block * stride).r;
}}

void put(int slot, float z, uint color)
{{
    depths[first_slot + slot * stride] = z;
    colors[first_slot + slot * stride] = color;
}}
)",
                                                fmt::arg("block_pixels", block_pixels),
                                                fmt::arg("k", k),
                                                fmt::arg("maxima", slot_blocks(k)));
}

/// The farthest of all slots, of which `filled` was just given the depth z.
std::string find_farthest_flat(int k)
{
    std::string source;
    for (int slot = 0; slot < k; ++slot)
        source += fmt::format("            d = filled == {0} ? z : depth({0});\n"
                              "            farthest = d > far ? {0} : farthest;\n"
                              "            far = max(far, d);\n",
                              slot);
    return source;
}

std::string insertion_flat(int k)
{
    return fmt::format(R"(
    bool full = state >= k;
    if (!full || z < limit()) {{
        int filled = full ? state - k : state;
        put(filled, z, color);
        ++state;
        if (state >= k) {{
            float d;
            float far = -1.0;
            int farthest = 0;
{}
            limits[state_of_pixel] = far;
            state = k + farthest;
        }}
    }}
)",
                       find_farthest_flat(k));
}

/// Here the state of a full pixel names the block with the farthest: k + the block's first slot.
std::string insertion_in_blocks(int k)
{
    std::string all;
    std::string second;
    std::string maxima;
    for (int block = 0; block < slot_blocks(k); ++block) {
        const int first = block * slots_in_block;
        all += "            d = -1.0;\n";
        for (int slot = first; slot < std::min(k, first + slots_in_block); ++slot)
            all += fmt::format("            d = max(d, filled == {0} ? z : depth({0}));\n", slot);
        all += fmt::format("            maxima[first_maximum + {0} * stride] = d;\n"
                           "            farthest = d > far ? {1} : farthest;\n"
                           "            far = max(far, d);\n",
                           block, first);
        maxima += fmt::format("        d = first == {1} ? z_block : maximum({0});\n"
                              "        farthest = d > far ? {1} : farthest;\n"
                              "        far = max(far, d);\n",
                              block, first);
    }
    for (int slot = 0; slot < slots_in_block; ++slot)
        second += fmt::format("        d = first + {0} < k ? depth(first + {0}) : -1.0;\n"
                              "        filled = d > most ? first + {0} : filled;\n"
                              "        second = max(second, min(d, most));\n"
                              "        most = max(most, d);\n",
                              slot);
    return fmt::format(R"(
    float d;
    float far = -1.0;
    int farthest = 0;
    if (state < k) {{
        int filled = state;
        put(filled, z, color);
        ++state;
        if (state == k) {{
{}
            limits[state_of_pixel] = far;
            state = k + farthest;
        }}
    }} else if (z < limit()) {{
        int first = state - k;
        int filled = first;
        float most = -1.0;
        float second = -1.0;
{}
        put(filled, z, color);
        float z_block = max(second, z);
        maxima[first_maximum + (first / {}) * stride] = z_block;
{}
        limits[state_of_pixel] = far;
        state = k + farthest;
    }}
)",
                       all, second, slots_in_block, maxima);
}

std::string store_source(Size size, int k, const std::string &variant)
{
    const std::string culling = R"(
    if (z >= limit())
        return;
)";
    const std::string locked = R"(
    const uint taken = ~0u;
    bool waiting = true;
    while (waiting) {
        uint held = atomicExchange(states[state_of_pixel], taken);
        if (held != taken) {
            int state = insert(int(held), z, color);
            memoryBarrier();
            states[state_of_pixel] = uint(state);
            waiting = false;
        }
    }
)";
    const std::string unlocked = R"(
    states[state_of_pixel] = uint(insert(int(states[state_of_pixel]), z, color));
)";
    return declarations(size, k) +
           fmt::format(R"(
/// Inserts into a pixel of this state and returns its new one.
int insert(int state, float z, uint color)
{{
{}
    return state;
}}

void main()
{{
    float z = gl_FragCoord.z;
{}
    uint color = packUnorm4x8(shade());
{}
}}
)",
                       k <= max_flat_k ? insertion_flat(k) : insertion_in_blocks(k),
                       variant == "no-culling" ? "" : culling,
                       variant == "unlocked" ? unlocked : locked);
}

std::string resolve_source(Size size, int k)
{
    return declarations(size, k) +
           fmt::format(
               R"(
out vec4 color;

void main()
{{
    int count = min(int(states[state_of_pixel]), k);
{}
{}
}}
)",
               declare_slots_glsl(0, k) + load_sorted_glsl(0, k, "count",
                                                           "z{0} = depth({0}); item{0} = "
                                                           "{0}u;"),
               composite_sorted_glsl(k, "count", "colors[first_slot + int(item{0}) * stride]"));
}

class KPlus final : public Renderer
{
public:
    KPlus(const Gl &gl, const std::string &variant, Size size, int k)
        : gl_(gl), k_(k), pixels_(block_count(size) * block_pixels), states_(gl, pixels_, GL_R32UI),
          limits_(gl, pixels_, GL_R32F),
          depths_(gl, pixels_ * static_cast<std::size_t>(k), GL_R32F),
          colors_(gl, pixels_ * static_cast<std::size_t>(k), GL_R32UI),
          maxima_(gl, pixels_ * static_cast<std::size_t>(slot_blocks(k)), GL_R32F), empty_(gl),
          store_(make_geometry_program(gl, "", store_source(size, k, variant))),
          resolve_(make_view_program(gl, resolve_source(size, k)))
    {
    }

    void draw(const GlScene &scene, GLuint target) override
    {
        states_.clear(pixels_, 0);
        limits_.clear(pixels_, std::bit_cast<GLuint>(behind_all));
        states_.bind_storage(0);
        limits_.bind_storage(1);
        depths_.bind_storage(2);
        colors_.bind_storage(3);
        maxima_.bind_storage(4);
        limits_.bind_image(0);
        depths_.bind_image(1);
        maxima_.bind_image(2);

        gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
        draw_without_color(gl_, scene, store_);
        gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
        resolve_.use();
        draw_full_screen(gl_, empty_);
    }

    int bytes_per_pixel() const override { return 8 * k_ + 4 * slot_blocks(k_) + 2 * 4; }

private:
    const Gl &gl_;
    int k_;
    std::size_t pixels_;
    StorageBuffer states_;
    StorageBuffer limits_;
    StorageBuffer depths_;
    StorageBuffer colors_;
    StorageBuffer maxima_;
    VertexArray empty_;
    Program store_;
    Program resolve_;
};

} // namespace

std::unique_ptr<Renderer> make_k_plus(const Gl &gl, const std::string &variant, Size size, int k)
{
    return std::make_unique<KPlus>(gl, variant, size, k);
}

} // namespace kb::bench
