// SPDX-License-Identifier: MIT
//
// GL_MESA_kbuffer_program: insertion by the programs of samples/programs, composition by programs
// that blend in single precision.

#include "tests/hard_cases/method.hpp"

#include "bench/gl_scene.hpp"
#include "programs/kbuffer_program.hpp"

#include <array>
#include <regex>

namespace kb::hard
{

using bench::must;

namespace
{

/// The generator's program, which compares by z < entry, for another order.
std::string insertion_program(int k, GLenum func)
{
    const std::string text = must(make_insertion_program(EntryLayout::rgbz, k));
    static const std::regex less(R"(SLT (\S+), (fragment\.position\.z), (kbuffer\[\d+\]\.w);)");
    switch (func) {
    case GL_LEQUAL:
        return std::regex_replace(text, less, "SGE $1, $3, $2;");
    case GL_GREATER:
        return std::regex_replace(text, less, "SLT $1, $3, $2;");
    case GL_GEQUAL:
        return std::regex_replace(text, less, "SGE $1, $2, $3;");
    default:
        return text;
    }
}

// Entry 0 is (color over black, alpha). The fragment is (value, alpha).
constexpr const char *under_program = "!!ARBfp1.0\n"
                                      "OPTION MESA_kbuffer_program;\n"
                                      "TEMP light, new;\n"
                                      "SUB light, 1.0, kbuffer[0].y;\n"
                                      "MUL new.x, fragment.color.x, fragment.color.y;\n"
                                      "MOV new.y, fragment.color.y;\n"
                                      "MAD result.kbuffer[0].xy, light, new, kbuffer[0];\n"
                                      "END\n";
constexpr const char *over_program = "!!ARBfp1.0\n"
                                     "OPTION MESA_kbuffer_program;\n"
                                     "TEMP light, new;\n"
                                     "SUB light, 1.0, fragment.color.y;\n"
                                     "MUL new.x, fragment.color.x, fragment.color.y;\n"
                                     "MOV new.y, fragment.color.y;\n"
                                     "MAD result.kbuffer[0].xy, light, kbuffer[0], new;\n"
                                     "END\n";

class ProgramMethod final : public Method
{
public:
    explicit ProgramMethod(const Gl &gl) : gl_(gl) {}

    std::string_view name() const override { return "kbuffer-program"; }
    bool continues() const override { return false; }

    std::string why_not(const Shape &shape) const override
    {
        if (shape.depth_format != GL_DEPTH_COMPONENT32F)
            return "depths lie in color entries, and programs compare what is not yet converted: "
                   "only 32-bit floats are compared as they are stored";
        return {};
    }

    std::vector<Pass> draw_passes(const Shape &shape, int, const Draw &draw) override
    {
        const auto entries = run(shape, shape.k, insertion_program(shape.k, shape.func), draw);
        Layers layers(entries.front().size());
        for (const auto &entry : entries)
            for (std::size_t i = 0; i < layers.size(); ++i)
                if (static_cast<double>(entry[i].w) != shape.empty_depth())
                    layers[i].push_back(
                        {static_cast<double>(entry[i].w), entry[i].x, entry[i].y, entry[i].z});
        return {{deliver(std::move(layers)), false}};
    }

    std::vector<Composite> compose(const Shape &shape, Direction direction,
                                   const Draw &draw) override
    {
        const char *program = direction == Direction::front_to_back ? under_program : over_program;
        const auto sums = run(shape, 1, program, draw).front();
        // As layers, for the sake of the flaw.
        Layers layers;
        for (const glm::vec4 &sum : sums)
            layers.push_back({{0.0, sum.x, sum.y, 0.0F}});
        std::vector<Composite> composites;
        for (const auto &sample : deliver(std::move(layers)))
            composites.push_back(sample.empty() ? Composite{}
                                                : Composite{sample[0].value, sample[0].alpha});
        return composites;
    }

private:
    /// All samples of each entry.
    std::vector<std::vector<glm::vec4>> run(const Shape &shape, int entries,
                                            const std::string &program, const Draw &draw)
    {
        const auto [width, height] = shape.size;
        const LayerReader reader(gl_, shape.size, shape.samples);
        const Texture texture =
            shape.samples > 0 ? make_texture_2d_multisample_array(gl_, GL_RGBA32F, shape.samples,
                                                                  width, height, entries)
                              : make_texture_2d_array(gl_, GL_RGBA32F, width, height, entries);
        const Framebuffer framebuffer(gl_);
        gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
        gl_.FramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture.id(), 0);
        must(check_framebuffer(gl_));
        gl_.Viewport(0, 0, width, height);
        const std::array<GLfloat, 4> empty{0.0F, 0.0F, 0.0F,
                                           static_cast<float>(shape.empty_depth())};
        gl_.ClearBufferfv(GL_COLOR, 0, empty.data());
        const ArbProgram arb = must(ArbProgram::make(gl_, GL_KBUFFER_PROGRAM_MESA, program));
        gl_.Enable(GL_KBUFFER_PROGRAM_MESA);
        draw();
        gl_.Disable(GL_KBUFFER_PROGRAM_MESA);
        must(check_gl(gl_, "drawing into a k-buffer"));

        std::vector<std::vector<glm::vec4>> values(static_cast<std::size_t>(entries));
        for (int entry = 0; entry < entries; ++entry) {
            auto &all = values[static_cast<std::size_t>(entry)];
            for (int sample = 0; sample < reader.samples(); ++sample) {
                const auto some = reader.read_color(texture, entry, sample);
                all.insert(all.end(), some.begin(), some.end());
            }
        }
        return values;
    }

    const Gl &gl_;
};

} // namespace

std::unique_ptr<Method> make_program(const Gl &gl)
{
    return std::make_unique<ProgramMethod>(gl);
}

} // namespace kb::hard
