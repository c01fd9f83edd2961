// SPDX-License-Identifier: MIT
//
// A scene on the driver: drawn triangle by triangle without the extensions, which gives all
// fragments, and drawn with the extension, which gives layers.

#pragma once

#include "tests/reference/gl_target.hpp"
#include "tests/reference/rasterizer.hpp"
#include "tests/reference/scene.hpp"

#include <map>
#include <string>
#include <vector>

namespace kb::reference
{

/// What a triangle alone leaves: of every sample the number of fragments, and the color and the
/// depth as stored of the last of them. There is one or none; but the clipper makes triangles of a
/// triangle, and where snapping turns one of them over, two of them cover a sample.
struct TriangleDump {
    std::vector<std::uint8_t> count;
    std::vector<Color> color;
    std::vector<std::uint32_t> depth;

    bool covers(std::size_t sample) const { return count[sample] > 0; }
};

/// What one pass leaves.
struct Pass {
    std::vector<std::vector<Color>> colors; ///< By attachment, then by layer and sample.
    std::vector<std::uint32_t> depth;       ///< By layer and sample.
    std::vector<Color> composite; ///< Of each pixel the layers over each other and, as alpha, what
                                  ///< shines through; empty if no attachment is fit for it.
    bool overflow = false;
};

/// What is kept of the fragments: the color attachments, or what a k-buffer program makes of them.
std::vector<ColorFormat> kept_colors(const Scene &scene);
DepthFormat kept_depth(const Scene &scene);

/// The attachment that is composed, if any is.
std::optional<std::size_t> composed_attachment(const Scene &scene);

/// Color channel c of attachment a is channel (a + c) % 4 of the fragment's color.
inline std::size_t source_channel(std::size_t attachment, std::size_t channel)
{
    return (attachment + channel) % 4;
}

class SceneDrawer
{
public:
    explicit SceneDrawer(const Gl &gl);

    /// An error if the driver lacks what the scene needs.
    Status check_support(const Scene &scene) const;
    Result<RasterRules> rules(const Scene &scene) const;

    Result<std::vector<TriangleDump>> dump(const Scene &scene);
    Result<std::vector<Pass>> draw(const Scene &scene);

private:
    struct StepRange {
        const Step *step;
        int first;
        int count;
    };

    const Gl &gl() const { return *gl_; }
    Status upload(const Scene &scene);
    void set_state(const Scene &scene) const;
    void begin_step(const Step &step) const;
    void clear(const Scene &scene, std::size_t attachments) const;
    void draw_steps(const Scene &scene, std::size_t attachments) const;
    Result<const Program *> program_of(const std::string &vertex, const std::string &fragment);
    Result<std::vector<Color>> compose(const Scene &scene, const Target &target);
    Result<std::vector<Pass>> peel(const Scene &scene);
    Result<std::vector<Pass>> run_program(const Scene &scene);
    Result<const ArbProgram *> kbuffer_program(const Scene &scene);

    const Gl *gl_;
    SampleReader reader_;
    VertexArray array_;
    VertexArray empty_;
    Buffer vertices_;
    std::vector<StepRange> steps_;
    std::map<std::string, Program> programs_;
    std::map<std::string, ArbProgram> kbuffer_programs_;
};

} // namespace kb::reference
