// SPDX-License-Identifier: MIT

#pragma once

#include "lib/gl/gl_objects.hpp"
#include "lib/io/image.hpp"
#include "lib/scene/camera.hpp"

#include <functional>
#include <vector>

namespace kb
{

/// What GL_MESA_depth_peeling is to fill.
struct PeelingLayers {
    Size size;
    int count = 8; ///< k: how many layers a pass fills.
    /// LESS and LEQUAL put the nearest fragment into layer 0, GREATER and GEQUAL the farthest.
    GLenum func = GL_LESS;
    GLenum depth_format = GL_DEPTH_COMPONENT32F;
    std::vector<GLenum> color_formats{GL_RGBA8}; ///< One for each color attachment.
    int samples = 0;                             ///< 0: not multisampled.
};

/// The layers and the framebuffer that they are attached to: depth and colors are arrays of k
/// layers. A pass is
///
///     peeling.clear();
///     gl.Enable(GL_DEPTH_PEELING_MESA);
///     ... draw ...
///     gl.Disable(GL_DEPTH_PEELING_MESA);
///
/// and layer i then holds the fragment of rank first_layer() + i of every pixel. While overflow()
/// says that there is more behind the last layer, advance() and a further pass over the same
/// geometry in the same order give the next k ranks.
class DepthPeeling
{
public:
    static Result<DepthPeeling> make(const Gl &gl, const PeelingLayers &layers);

    /// Empties the layers and sets the depth function; leaves the framebuffer bound.
    void clear() const;

    /// Lets the next pass begin at rank 0 again, and forgets the overflow.
    Status restart();

    /// Lets the next pass begin behind what the layers hold now.
    Status advance();

    int first_layer() const { return first_layer_; }
    bool overflow() const;

    /// Color attachment a to texture unit a, the depth to the unit after the last of them: as
    /// sampler2DArray, or sampler2DMSArray with samples.
    void bind_textures() const;

    /// The depth of a layer where it has no fragment.
    float empty_depth() const;

    /// A layer, top row first. Of samples the average, and the depth of one of them.
    ImageRgbaF read_color(int layer, int attachment = 0) const;
    ImageF read_depth(int layer) const;

    /// The layers of color attachment 0.
    const Texture &color() const { return colors_.front(); }
    const Texture &depth() const { return depth_; }

    const PeelingLayers &layers() const { return layers_; }
    int bytes_per_pixel() const;

private:
    DepthPeeling(const Gl &gl, PeelingLayers layers, Texture depth)
        : framebuffer_(gl), depth_(std::move(depth)), layers_(std::move(layers))
    {
    }

    void bind() const;
    Status set_first_layer(int rank);

    struct Attachment {
        GLenum point;
        const Texture &texture;
        GLenum format;
    };
    /// Calls `read` with a framebuffer of one layer: reading a layered one gives layer 0.
    void with_single_layer(const Attachment &attachment, int layer,
                           const std::function<void(GLuint)> &read) const;

    Framebuffer framebuffer_;
    Texture depth_;
    std::vector<Texture> colors_;
    PeelingLayers layers_;
    int first_layer_ = 0;
};

} // namespace kb
