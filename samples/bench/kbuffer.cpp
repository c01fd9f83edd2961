// SPDX-License-Identifier: MIT
//
// A k-buffer program: the fragment shader only shades, and the program that runs after it in the
// place of blending inserts the fragment.

#include "programs/kbuffer_program.hpp"

#include "bench/packed_entries.hpp"
#include "bench/renderer.hpp"
#include "lib/gl/context.hpp"

namespace kb::bench
{

namespace
{

class KbufferProgram final : public Renderer
{
public:
    KbufferProgram(const Gl &gl, Size size, int k)
        : gl_(gl), entries_(gl, size, k), shading_(make_geometry_program(gl, "", R"(
out vec4 color;

void main()
{
    color = shade();
}
)")),
          insertion_(must(ArbProgram::make(gl, GL_KBUFFER_PROGRAM_MESA,
                                           must(make_insertion_program(EntryLayout::packed, k)))))
    {
    }

    void draw(const GlScene &scene, GLuint target) override
    {
        entries_.begin();
        insertion_.bind();
        gl_.Enable(GL_KBUFFER_PROGRAM_MESA);
        scene.draw(shading_);
        gl_.Disable(GL_KBUFFER_PROGRAM_MESA);
        entries_.resolve(target);
    }

    int bytes_per_pixel() const override { return entries_.bytes_per_pixel(); }

private:
    const Gl &gl_;
    PackedEntries entries_;
    Program shading_;
    ArbProgram insertion_;
};

} // namespace

std::unique_ptr<Renderer> make_kbuffer_program(const Gl &gl, Size size, int k)
{
    must(require_kbuffer_program(gl));
    return std::make_unique<KbufferProgram>(gl, size, k);
}

} // namespace kb::bench
