// SPDX-License-Identifier: MIT
//
// A k-buffer by framebuffer fetch, as stock Mesa can do it: the fragment shader reads the entries
// of its pixel, inserts the fragment and writes them back.

#include "bench/packed_entries.hpp"
#include "bench/renderer.hpp"

#include <stdexcept>

#include <fmt/format.h>

namespace kb::bench
{

namespace
{

std::string insertion(int k, int entries)
{
    const auto color = [](int slot) {
        return fmt::format("entry{}.{}", slot / 2, slot % 2 == 0 ? 'x' : 'z');
    };
    const auto depth = [](int slot) {
        return fmt::format("entry{}.{}", slot / 2, slot % 2 == 0 ? 'y' : 'w');
    };

    std::string source;
    for (int i = 0; i < entries; ++i)
        source += fmt::format("layout(location = {0}) inout vec4 entry{0};\n", i);
    source += fmt::format(R"(
void main()
{{
    float z = gl_FragCoord.z;
    if (z >= {})
        return; // Much faster in llvmpipe than to discard, and than no test at all.
    float color = uintBitsToFloat(packUnorm4x8(shade()));
)",
                          depth(k - 1));
    // The slots are in order of depth, so "nearer than slot i" implies it of every slot behind i.
    // From the last to the first each takes the slot before it, the fragment, or keeps what it has.
    source += fmt::format("    bool nearer{} = true;\n", k - 1);
    for (int slot = k - 1; slot > 0; --slot) {
        source +=
            fmt::format("    bool nearer{0} = z < {1};\n"
                        "    {2} = nearer{0} ? {3} : nearer{4} ? color : {2};\n"
                        "    {5} = nearer{0} ? {1} : nearer{4} ? z : {5};\n",
                        slot - 1, depth(slot - 1), color(slot), color(slot - 1), slot, depth(slot));
    }
    return source + fmt::format("    {0} = nearer0 ? color : {0};\n"
                                "    {1} = nearer0 ? z : {1};\n}}\n",
                                color(0), depth(0));
}

class Fbfetch final : public Renderer
{
public:
    Fbfetch(const Gl &gl, Size size, int k)
        : entries_(gl, size, k),
          program_(make_geometry_program(gl,
                                         "#extension GL_EXT_shader_framebuffer_fetch : require\n",
                                         insertion(k, entries_.entries())))
    {
    }

    void draw(const GlScene &scene, GLuint target) override
    {
        entries_.begin();
        scene.draw(program_);
        entries_.resolve(target);
    }

    int bytes_per_pixel() const override { return entries_.bytes_per_pixel(); }

private:
    PackedEntries entries_;
    Program program_;
};

} // namespace

std::unique_ptr<Renderer> make_fbfetch(const Gl &gl, Size size, int k)
{
    if (!has_extension(gl, "GL_EXT_shader_framebuffer_fetch"))
        throw std::runtime_error("the driver has no GL_EXT_shader_framebuffer_fetch");
    return std::make_unique<Fbfetch>(gl, size, k);
}

} // namespace kb::bench
