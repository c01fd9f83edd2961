// SPDX-License-Identifier: MIT

#pragma once

#include "lib/app/long_work.hpp"
#include "volume/segment_lookup.hpp"
#include "volume/sorted_faces.hpp"
#include "volume/transfer_function.hpp"

#include <glm/vec3.hpp>

#include <memory>

namespace kb
{

struct VolumeSettings {
    Size size;
    int k = 6; ///< Fragments that wait in the k-buffer, or layers a pass of the exact renderer.
    TransferFunction transfer; ///< Normalized.
    glm::vec3 background{1.0F};
    SegmentLookup lookup{}; ///< Of the k-buffer program.
    GoOn go_on{};           ///< Between passes of the exact renderer: an error if that ends it.
};

/// Draws faces as a volume into a picture of floats.
class VolumeRenderer
{
public:
    virtual ~VolumeRenderer() = default;

    /// For the camera that the faces are sorted for.
    virtual Status draw(const SortedFaces &faces) = 0;

    /// The picture is color attachment 0 of this framebuffer: the background is in it, alpha is 1
    /// less the transmittance.
    virtual GLuint framebuffer() const = 0;

    /// How often the last draw drew the faces.
    virtual int passes() const = 0;
    virtual int bytes_per_pixel() const = 0;
};

/// One pass: a k-buffer program puts fragments in order that are no more than k places from where
/// they belong, and composites.
Result<std::unique_ptr<VolumeRenderer>> make_kbuffer_renderer(const Gl &gl,
                                                              const VolumeSettings &settings);

/// Every fragment in its place, in as many passes as it takes: depth peeling with continuation.
Result<std::unique_ptr<VolumeRenderer>> make_exact_renderer(const Gl &gl,
                                                            const VolumeSettings &settings);

} // namespace kb
