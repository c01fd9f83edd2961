// SPDX-License-Identifier: MIT

#include "isosurface/fragment_stream.hpp"

#include "volume/disorder_capture.hpp"
#include "volume/face_program.hpp"

namespace kb
{

namespace
{

constexpr const char *fragment_shader = R"(
layout(location = 0) out vec4 fragment;

void main()
{
    fragment = vec4(ray_distance(), tagged_scalar(), 0.0, 0.0);
}
)";

class FaceStream final : public FragmentStream
{
public:
    FaceStream(const Gl &gl, const FaceMesh &mesh, ScalarRange range, FaceOrder order,
               Program program)
        : gl_(gl), faces_(gl, mesh, range, order), program_(std::move(program))
    {
    }

    void sort(const OrbitCamera &camera, Size size) override { faces_.sort(camera, size); }

    void draw(const OrbitCamera &, Size size) const override
    {
        draw_faces(gl_, program_, faces_, size);
    }

    Result<Disorder> capture_disorder(const OrbitCamera &, Size size,
                                      const GoOn &go_on) const override
    {
        return kb::capture_disorder(gl_, faces_, size, go_on);
    }

    Medium medium() const override { return Medium::grid; }
    std::size_t count() const override { return faces_.count(); }
    std::string_view primitive() const override { return "triangles"; }

private:
    const Gl &gl_;
    SortedFaces faces_;
    Program program_;
};

} // namespace

Result<std::unique_ptr<FragmentStream>> make_face_stream(const Gl &gl, const FaceMesh &mesh,
                                                         ScalarRange range, FaceOrder order)
{
    auto program = make_face_program(gl, fragment_shader);
    if (!program)
        return program.error();
    return std::unique_ptr<FragmentStream>(
        std::make_unique<FaceStream>(gl, mesh, range, order, std::move(*program)));
}

} // namespace kb
