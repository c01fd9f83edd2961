// SPDX-License-Identifier: MIT

#include "bench/capture.hpp"

#include "bench/exact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace kb::bench
{

namespace
{

// Fragments are captured into textures of this size, which limits how many there are in a band.
constexpr int store_width = 4096;
constexpr int store_height = 1024;
constexpr std::size_t store_size = std::size_t{store_width} * store_height;

Program make_count_program(const Gl &gl)
{
    return make_geometry_program(gl, "", R"(
layout(binding = 0, r32ui) uniform uimage2D cursors;

void main()
{
    imageAtomicAdd(cursors, ivec2(gl_FragCoord.xy), 1u);
}
)");
}

Program make_store_program(const Gl &gl)
{
    return make_geometry_program(gl, "",
                                 fmt::format(R"(
layout(binding = 0, r32ui) uniform uimage2D cursors;
layout(binding = 1, rgba32f) writeonly uniform image2D colors;
layout(binding = 2, r32f) writeonly uniform image2D depths;

void main()
{{
    int slot = int(imageAtomicAdd(cursors, ivec2(gl_FragCoord.xy), 1u));
    ivec2 place = ivec2(slot % {0}, slot / {0});
    imageStore(colors, place, shade());
    imageStore(depths, place, vec4(gl_FragCoord.z));
}}
)",
                                             store_width));
}

/// Rows of the view, the bottom one first.
struct Band {
    int first;
    int last; ///< One behind the last row.
};

class FragmentStore
{
public:
    FragmentStore(const Gl &gl, const GlScene &scene, Size size)
        : gl_(gl), scene_(scene), size_(size), count_(make_count_program(gl)),
          store_(make_store_program(gl)), cursors_(gl),
          colors_(make_texture_2d(gl, GL_RGBA32F, store_width, store_height)),
          depths_(make_texture_2d(gl, GL_R32F, store_width, store_height)),
          target_(make_texture_2d(gl, GL_RGBA8, size.width, size.height)), framebuffer_(gl)
    {
        gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
        gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target_.id(),
                                0);
        must(check_framebuffer(gl));
    }

    /// The number of fragments of each pixel.
    std::vector<GLuint> count()
    {
        std::vector<GLuint> counts(static_cast<std::size_t>(size_.width) *
                                   static_cast<std::size_t>(size_.height));
        set_cursors(counts);
        draw(count_, {0, size_.height});
        gl_.BindTexture(GL_TEXTURE_2D, cursors_.id());
        gl_.GetTexImage(GL_TEXTURE_2D, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, counts.data());
        return counts;
    }

    /// All fragments of a band; those of a pixel start at its cursor, in order of arrival.
    std::vector<Fragment> capture(Band band, const std::vector<GLuint> &cursors, std::size_t total)
    {
        set_cursors(cursors);
        gl_.BindImageTexture(1, colors_.id(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32F);
        gl_.BindImageTexture(2, depths_.id(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32F);
        draw(store_, band);

        std::vector<glm::vec4> colors(store_size);
        std::vector<float> depths(store_size);
        gl_.BindTexture(GL_TEXTURE_2D, colors_.id());
        gl_.GetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, colors.data());
        gl_.BindTexture(GL_TEXTURE_2D, depths_.id());
        gl_.GetTexImage(GL_TEXTURE_2D, 0, GL_RED, GL_FLOAT, depths.data());
        std::vector<Fragment> fragments(total);
        for (std::size_t i = 0; i < total; ++i)
            fragments[i] = {colors[i], depths[i]};
        return fragments;
    }

private:
    void set_cursors(const std::vector<GLuint> &values)
    {
        gl_.BindTexture(GL_TEXTURE_2D, cursors_.id());
        gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_R32UI, size_.width, size_.height, 0, GL_RED_INTEGER,
                       GL_UNSIGNED_INT, values.data());
        gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        gl_.BindImageTexture(0, cursors_.id(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
    }

    void draw(const Program &program, Band band)
    {
        gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
        gl_.Enable(GL_SCISSOR_TEST);
        gl_.Scissor(0, band.first, size_.width, band.last - band.first);
        // No color is wanted. More than that: where a triangle covers a tile and writes all of its
        // color, llvmpipe drops the triangles before it, with the image stores that they would do.
        gl_.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        scene_.draw(program);
        gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        gl_.Disable(GL_SCISSOR_TEST);
        gl_.MemoryBarrier(GL_ALL_BARRIER_BITS);
    }

    const Gl &gl_;
    const GlScene &scene_;
    Size size_;
    Program count_;
    Program store_;
    Texture cursors_;
    Texture colors_;
    Texture depths_;
    Texture target_;
    Framebuffer framebuffer_;
};

} // namespace

Capture capture_exact_images(const Gl &gl, const GlScene &scene, Size size, std::span<const int> ks)
{
    FragmentStore store(gl, scene, size);
    const std::vector<GLuint> counts = store.count();
    const auto width = static_cast<std::size_t>(size.width);

    Capture capture;
    capture.images.assign(ks.size(), ImageRgbaF(size.width, size.height));
    for (const GLuint count : counts) {
        capture.fragments += count;
        capture.depth_complexity = std::max(capture.depth_complexity, count);
        capture.covered_pixels += count != 0 ? 1U : 0U;
    }

    for (Band band{0, 0}; band.first < size.height; band.first = band.last) {
        std::vector<GLuint> cursors(counts.size());
        std::size_t total = 0;
        for (; band.last < size.height; ++band.last) {
            const std::size_t first = static_cast<std::size_t>(band.last) * width;
            const std::span row = std::span(counts).subspan(first, width);
            if (total + std::accumulate(row.begin(), row.end(), std::size_t{0}) > store_size)
                break;
            for (std::size_t x = 0; x < width; ++x) {
                cursors[first + x] = static_cast<GLuint>(total);
                total += row[x];
            }
        }
        if (band.last == band.first)
            throw std::runtime_error("a row of pixels has too many fragments to capture");

        std::vector<Fragment> fragments = store.capture(band, cursors, total);
        for (int y = band.first; y < band.last; ++y) {
            for (int x = 0; x < size.width; ++x) {
                const std::size_t pixel =
                    static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
                const std::span own = std::span(fragments).subspan(cursors[pixel], counts[pixel]);
                sort_by_depth(own);
                for (std::size_t i = 0; i < ks.size(); ++i)
                    capture.images[i].at(x, size.height - 1 - y) =
                        glm::vec4(composite(own, ks[i]), 1.0);
            }
        }
    }
    must(check_gl(gl, "capturing fragments"));
    return capture;
}

} // namespace kb::bench
