// SPDX-License-Identifier: MIT
//
// Draw commands, with geometry that a few bytes stand for, and the queries about them.

#include "fuzz/draws/machine.hpp"
#include "fuzz/draws/promises.hpp"
#include "fuzz/finding.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace kb::fuzz
{

namespace
{

struct Vertex {
    std::array<GLfloat, 4> position;
    std::array<GLfloat, 4> color;
};

constexpr std::array<Named, 14> modes = {
    GL_NAMED(GL_TRIANGLES),
    GL_NAMED(GL_TRIANGLE_STRIP),
    GL_NAMED(GL_QUADS),
    GL_NAMED(GL_POINTS),
    GL_NAMED(GL_LINES),
    GL_NAMED(GL_TRIANGLE_FAN),
    GL_NAMED(GL_LINE_STRIP),
    GL_NAMED(GL_LINE_LOOP),
    GL_NAMED(GL_QUAD_STRIP),
    GL_NAMED(GL_POLYGON),
    GL_NAMED(GL_TRIANGLES_ADJACENCY),
    GL_NAMED(GL_LINES_ADJACENCY),
    GL_NAMED(GL_PATCHES),
    {15, "15"}, // No mode.
};

/// Rectangles over everything, two triangles each, at depths that go up, down, or are all the same.
std::vector<Vertex> stacked_rectangles(Args &args)
{
    static constexpr std::array<std::array<float, 2>, 6> corners = {
        {{-1, -1}, {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}}};
    std::vector<Vertex> vertices;
    const int count = 1 + args.below(20);
    const int step = args.below(3) - 1;
    const float first = 2.0F * args.unit() - 1.0F;
    for (int i = 0; i < count; ++i) {
        const float z = first + 0.05F * float(step * i);
        const float shade = float(i + 1) / 20.0F;
        for (const auto &corner : corners)
            vertices.push_back({{corner[0], corner[1], z, 1.0F}, {shade, 1.0F - shade, z, 0.5F}});
    }
    return vertices;
}

/// Triangles anywhere, some out of the view or behind the eye, of any depth.
std::vector<Vertex> random_triangles(Args &args)
{
    std::minstd_rand random(args.byte() + 1);
    const float size = 2.5F / float(1 + args.below(30));
    int count = 1 + args.below(60);
    if (count == 60)
        count = 3000; // More than the bins of a scene hold.
    const auto unit = [&random] { return float(random() % 2048) / 1024.0F - 1.0F; };
    std::vector<Vertex> vertices;
    for (int i = 0; i < count; ++i) {
        const float x = 1.2F * unit(), y = 1.2F * unit(), z = 1.1F * unit();
        for (int corner = 0; corner < 3; ++corner) {
            const float w = 1.0F + 0.5F * std::abs(unit());
            vertices.push_back(
                {{(x + size * unit()) * w, (y + size * unit()) * w, (z + 0.1F * unit()) * w, w},
                 {unit(), unit(), unit(), unit()}});
        }
    }
    return vertices;
}

/// Coordinates at and beyond the ends of what a rasterizer can take.
std::vector<Vertex> extreme_triangles(Args &args)
{
    constexpr float infinity = std::numeric_limits<float>::infinity();
    static constexpr std::array<float, 12> values = {
        0.0F,      1.0F,
        -1.0F,     1e10F,
        -1e10F,    std::numeric_limits<float>::max(),
        1e-38F,    infinity,
        -infinity, std::numeric_limits<float>::quiet_NaN(),
        0.5F,      1e5F};
    std::minstd_rand random(args.byte() + 1);
    std::vector<Vertex> vertices;
    for (int i = 3 * (1 + args.below(6)); i > 0; --i) {
        const auto any = [&random] { return values[random() % values.size()]; };
        vertices.push_back(
            {{any(), any(), any(), random() % 4 ? 1.0F : any()}, {any(), any(), any(), any()}});
    }
    return vertices;
}

std::vector<Vertex> geometry(Args &args)
{
    switch (args.below(4)) {
    case 0:
        return random_triangles(args);
    case 1:
        return extreme_triangles(args);
    default:
        return stacked_rectangles(args);
    }
}

void draw_immediate(Machine &machine, Named mode, const std::vector<Vertex> &vertices)
{
    CALL(machine, glBegin, mode);
    machine.trace.comment("{} vertices", vertices.size());
    for (const Vertex &vertex : vertices) {
        glColor4fv(vertex.color.data());
        glVertex4fv(vertex.position.data());
    }
    CALL(machine, glEnd);
}

void draw_arrays(Machine &machine, Named mode, const std::vector<Vertex> &vertices, int method)
{
    const int count = int(vertices.size());
    std::vector<GLuint> indices(vertices.size());
    std::iota(indices.rbegin(), indices.rend(), 0U);
    glVertexPointer(4, GL_FLOAT, sizeof(Vertex), vertices.front().position.data());
    glColorPointer(4, GL_FLOAT, sizeof(Vertex), vertices.front().color.data());
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    switch (method) {
    case 0:
        CALL(machine, glDrawElements, mode, count, GL_NAMED(GL_UNSIGNED_INT), indices.data());
        break;
    case 1:
        CALL(machine, glDrawArraysInstanced, mode, 0, count, 3);
        break;
    case 2: {
        const std::array<GLint, 2> first = {0, count / 2}, counts = {count / 2, count - count / 2};
        CALL(machine, glMultiDrawArrays, mode, first.data(), counts.data(), 2);
        break;
    }
    case 3:
        CALL(machine, glDrawRangeElements, mode, 0U, GLuint(count), count,
             GL_NAMED(GL_UNSIGNED_INT), indices.data());
        break;
    default:
        CALL(machine, glDrawArrays, mode, 0, count);
    }
    glDisableClientState(GL_VERTEX_ARRAY);
    glDisableClientState(GL_COLOR_ARRAY);
}

/// Stock GL refuses draws for what the state of the fragment stage is, or the kind of primitives.
bool may_be_refused(GLenum mode, bool integers)
{
    return mode > GL_POLYGON || integers || get_integer(GL_CURRENT_PROGRAM) != 0 ||
           glIsEnabled(GL_FRAGMENT_PROGRAM_ARB) || glIsEnabled(GL_BLEND);
}

constexpr unsigned draw_errors = invalid_enum | invalid_operation | invalid_framebuffer;

/// Integer color buffers need a shader.
bool draws_integers()
{
    GLboolean integers = GL_FALSE;
    glGetBooleanv(GL_RGBA_INTEGER_MODE_EXT, &integers);
    return integers;
}

void draw(Machine &machine, Args &args)
{
    const unsigned how = args.byte();
    const Named mode = modes[(args.byte() >> 2) * (how & 64 ? 1U : 0U) % modes.size()];
    const std::vector<Vertex> vertices = geometry(args);
    std::optional<DrawPromise> promise;
    // Not always: to look changes when the driver does its work.
    if ((how & 128) && !machine.compiling())
        promise.emplace(machine);

    if ((how & 7) < 2)
        draw_immediate(machine, mode, vertices);
    else
        draw_arrays(machine, mode, vertices, int(how & 7) - 2);

    if (!promise)
        return;
    const GLenum error = machine.check_error("drawing", draw_errors);
    promise->check(machine, error, may_be_refused(mode.value, draws_integers()));
}

void rectangle(Machine &machine, Args &args)
{
    std::optional<DrawPromise> promise;
    if (args.flag() && !machine.compiling())
        promise.emplace(machine);
    CALL(machine, glColor4f, args.unit(), args.unit(), args.unit(), args.unit());
    CALL(machine, glRectf, -1.0F, -1.0F, args.unit(), args.unit());
    if (!promise)
        return;
    const GLenum error = machine.check_error("glRectf", draw_errors);
    promise->check(machine, error, may_be_refused(GL_QUADS, draws_integers()));
}

/// Commands between Begin and End that are not allowed there must not change anything.
void between_begin_and_end(Machine &machine, Args &args)
{
    CALL(machine, glBegin, GL_NAMED(GL_TRIANGLES));
    glVertex3f(-1.0F, -1.0F, args.unit());
    switch (args.below(6)) {
    case 0:
        CALL(machine, glEnable, GL_NAMED(GL_DEPTH_PEELING_MESA));
        break;
    case 1:
        CALL(machine, glDisable, GL_NAMED(GL_KBUFFER_PROGRAM_MESA));
        break;
    case 2:
        CALL(machine, glDepthFunc, GL_NAMED(GL_GREATER));
        break;
    case 3:
        CALL(machine, glBindProgramARB, GL_NAMED(GL_KBUFFER_PROGRAM_MESA), 0);
        break;
    case 4:
        CALL(machine, glClear, GL_DEPTH_BUFFER_BIT);
        break;
    default:
        CALL(machine, glFramebufferParameteri, GL_NAMED(GL_DRAW_FRAMEBUFFER),
             GL_NAMED(GL_DEPTH_PEELING_FIRST_LAYER_MESA), 0);
    }
    glVertex3f(1.0F, -1.0F, args.unit());
    glVertex3f(0.0F, 1.0F, args.unit());
    CALL(machine, glEnd);
}

constexpr std::array<Named, 4> query_targets = {
    GL_NAMED(GL_SAMPLES_PASSED), GL_NAMED(GL_ANY_SAMPLES_PASSED), GL_NAMED(GL_PRIMITIVES_GENERATED),
    GL_NAMED(GL_TIME_ELAPSED)};

void begin_query(Machine &machine, Args &args)
{
    const GLuint name = machine.queries[machine.context()][args.flag()];
    CALL(machine, glBeginQuery, args.pick(query_targets), name);
}

void end_query(Machine &machine, Args &args)
{
    CALL(machine, glEndQuery, args.pick(query_targets));
}

void query_result(Machine &machine, Args &args)
{
    const GLuint name = machine.queries[machine.context()][args.flag()];
    GLuint result = 0;
    CALL(machine, glGetQueryObjectuiv, name, GL_NAMED(GL_QUERY_RESULT), &result);
}

void conditional_render(Machine &machine, Args &args)
{
    const GLuint name = machine.queries[machine.context()][args.flag()];
    if (args.flag())
        CALL(machine, glBeginConditionalRender, name, GL_NAMED(GL_QUERY_WAIT));
    else
        CALL(machine, glEndConditionalRender);
}

constexpr std::array<Command, 7> commands{{
    {"draw", draw, draw_errors | invalid_value, true, 16},
    {"rectangle", rectangle, draw_errors, true, 2},
    {"between_begin_and_end", between_begin_and_end, draw_errors, true},
    {"begin_query", begin_query, invalid_enum | invalid_operation},
    {"end_query", end_query, invalid_enum | invalid_operation},
    {"query_result", query_result, invalid_operation},
    {"conditional_render", conditional_render, invalid_operation},
}};

} // namespace

std::span<const Command> draw_commands()
{
    return commands;
}

} // namespace kb::fuzz
