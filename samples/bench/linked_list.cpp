// SPDX-License-Identifier: MIT
//
// Per-pixel linked lists (Yang, Hensley, Gruen and Thibieroz 2010): the geometry pass appends every
// fragment to the list of its pixel, with an atomic counter for the nodes and an atomic exchange of
// the list's head; the resolve keeps the k nearest of each list, sorted, and composites them.
//
// The fragments that are shaded together take their nodes by one step of the counter, and a node is
// spread over three buffers: in llvmpipe both are faster than the plain way.

#include "bench/renderer.hpp"
#include "bench/sorting_network.hpp"
#include "bench/storage_buffer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <stdexcept>

namespace kb::bench
{

namespace
{

const std::string extensions = "#extension GL_ARB_shader_ballot : require\n"
                               "#extension GL_ARB_gpu_shader_int64 : require\n";

std::string declarations(Size size)
{
    return pixel_order_glsl(size) + fmt::format(R"(
layout(std430, binding = 0) coherent buffer Counter {{ uint next_node; }};
layout(std430, binding = 1) coherent buffer Heads {{ uint heads[]; }};
const uint end = ~0u;

int pixel()
{{
    return block_of_pixel() * {} + place_in_block();
}}
)",
                                                block_pixels);
}

// Stores past the end of a buffer are dropped (ARB_robust_buffer_access_behavior): a list that does
// not fit shows in the counter.
std::string store_source(Size size)
{
    return declarations(size) + R"(
layout(std430, binding = 2) coherent writeonly buffer Nexts { uint nexts[]; };
layout(std430, binding = 3) coherent writeonly buffer Depths { float depths[]; };
layout(std430, binding = 4) coherent writeonly buffer Colors { uint colors[]; };

/// A node for each fragment of the subgroup, which has 32 invocations at most.
uint take_node()
{
    uint members = unpackUint2x32(ballotARB(true)).x;
    uint before = unpackUint2x32(gl_SubGroupLtMaskARB).x;
    uint first = 0u;
    if ((members & before) == 0u)
        first = atomicAdd(next_node, uint(bitCount(members)));
    return readFirstInvocationARB(first) + uint(bitCount(members & before));
}

void main()
{
    uint node = take_node();
    nexts[node] = atomicExchange(heads[pixel()], node);
    depths[node] = gl_FragCoord.z;
    colors[node] = packUnorm4x8(shade());
}
)";
}

// A list is read in runs of as many nodes as are kept; each is sorted and merged with the nearest
// ones so far. Nodes are numbered in order of arrival, which decides where depths are equal.
std::string resolve_source(Size size, int k)
{
    constexpr int least_run = 4;
    const int run = std::max(least_run, static_cast<int>(std::bit_ceil(static_cast<unsigned>(k))));
    const std::string left = fmt::format("(node == end ? 0 : {})", run);
    return declarations(size) +
           fmt::format(
               R"(
layout(binding = 0, r32ui) readonly uniform uimageBuffer nexts;
layout(binding = 1, r32f) readonly uniform imageBuffer depths;
layout(binding = 2, r32ui) readonly uniform uimageBuffer colors;
out vec4 color;

uint color_of(uint node)
{{
    return imageLoad(colors, int(node)).r;
}}

void main()
{{
    uint node = heads[pixel()];
    int count = 0;
{nearest}
    while (node != end) {{
{next_run}
{sort}
{merge}
    }}
{composite}
}}
)",
               fmt::arg("nearest", declare_slots_glsl(0, run)),
               fmt::arg("next_run", declare_slots_glsl(run, run)),
               fmt::arg("sort", load_sorted_glsl(run, run, left, R"(
        z{0} = imageLoad(depths, int(node)).r;
        item{0} = node;
        node = imageLoad(nexts, int(node)).r;
        ++count;)")),
               fmt::arg("merge", merge_nearest_glsl(run)),
               fmt::arg("composite", composite_sorted_glsl(k, "count", "color_of(item{0})")));
}

class LinkedList final : public Renderer
{
public:
    LinkedList(const Gl &gl, Size size, int k)
        : gl_(gl), shown_pixels_(static_cast<std::size_t>(size.width) *
                                 static_cast<std::size_t>(size.height)),
          pixels_(block_count(size) * block_pixels), counter_(gl, 1, GL_R32UI),
          heads_(gl, pixels_, GL_R32UI), nexts_(gl, capacity_, GL_R32UI),
          depths_(gl, capacity_, GL_R32F), colors_(gl, capacity_, GL_R32UI), empty_(gl),
          store_(make_geometry_program(gl, extensions, store_source(size))),
          resolve_(make_view_program(gl, resolve_source(size, k)))
    {
        counter_.clear(1, 0);
    }

    void draw(const GlScene &scene, GLuint target) override
    {
        gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
        if (!grown_) {
            // Only here, outside of what is measured, does a frame wait to see what it needs.
            append_all(scene);
            grow();
            grown_ = true;
        }
        append_all(scene);
        gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
        nexts_.bind_image(0);
        depths_.bind_image(1);
        colors_.bind_image(2);
        resolve_.use();
        draw_full_screen(gl_, empty_);
    }

    /// Of the scene that was drawn, on the average over all pixels.
    int bytes_per_pixel() const override
    {
        constexpr std::size_t node_bytes = 12;
        return static_cast<int>(4 + (capacity_ * node_bytes + shown_pixels_ - 1) / shown_pixels_);
    }

private:
    void append_all(const GlScene &scene)
    {
        counter_.clear(1, 0);
        heads_.clear(pixels_, ~0U);
        counter_.bind_storage(0);
        heads_.bind_storage(1);
        nexts_.bind_storage(2);
        depths_.bind_storage(3);
        colors_.bind_storage(4);
        draw_without_color(gl_, scene, store_);
    }

    void grow()
    {
        capacity_ = std::max<std::size_t>(counter_.read(), 1);
        nexts_ = StorageBuffer(gl_, capacity_, GL_R32UI);
        depths_ = StorageBuffer(gl_, capacity_, GL_R32F);
        colors_ = StorageBuffer(gl_, capacity_, GL_R32UI);
    }

    const Gl &gl_;
    std::size_t shown_pixels_;
    std::size_t pixels_;
    std::size_t capacity_ = 1; ///< Nodes.
    bool grown_ = false;
    StorageBuffer counter_;
    StorageBuffer heads_;
    StorageBuffer nexts_;
    StorageBuffer depths_;
    StorageBuffer colors_;
    VertexArray empty_;
    Program store_;
    Program resolve_;
};

} // namespace

std::unique_ptr<Renderer> make_linked_list(const Gl &gl, Size size, int k)
{
    for (const char *name : {"GL_ARB_shader_ballot", "GL_ARB_gpu_shader_int64"})
        if (!has_extension(gl, name))
            throw std::runtime_error(fmt::format("the driver has no {}", name));
    return std::make_unique<LinkedList>(gl, size, k);
}

} // namespace kb::bench
