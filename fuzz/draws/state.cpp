// SPDX-License-Identifier: MIT
//
// State: of the extensions, and all other per-fragment and rasterization state that they meet;
// the attribute stack, display lists, and the two contexts.

#include "fuzz/draws/machine.hpp"
#include "fuzz/finding.hpp"

namespace kb::fuzz
{

namespace
{

constexpr std::array<Named, 32> capabilities = {
    GL_NAMED(GL_DEPTH_PEELING_MESA),
    GL_NAMED(GL_KBUFFER_PROGRAM_MESA),
    GL_NAMED(GL_DEPTH_TEST),
    GL_NAMED(GL_STENCIL_TEST),
    GL_NAMED(GL_SCISSOR_TEST),
    GL_NAMED(GL_ALPHA_TEST),
    GL_NAMED(GL_BLEND),
    GL_NAMED(GL_COLOR_LOGIC_OP),
    GL_NAMED(GL_CULL_FACE),
    GL_NAMED(GL_DEPTH_CLAMP),
    GL_NAMED(GL_FRAMEBUFFER_SRGB),
    GL_NAMED(GL_MULTISAMPLE),
    GL_NAMED(GL_SAMPLE_ALPHA_TO_COVERAGE),
    GL_NAMED(GL_SAMPLE_ALPHA_TO_ONE),
    GL_NAMED(GL_SAMPLE_COVERAGE),
    GL_NAMED(GL_SAMPLE_MASK),
    GL_NAMED(GL_SAMPLE_SHADING),
    GL_NAMED(GL_RASTERIZER_DISCARD),
    GL_NAMED(GL_POLYGON_OFFSET_FILL),
    GL_NAMED(GL_POLYGON_STIPPLE),
    GL_NAMED(GL_POLYGON_SMOOTH),
    GL_NAMED(GL_LINE_SMOOTH),
    GL_NAMED(GL_LINE_STIPPLE),
    GL_NAMED(GL_POINT_SMOOTH),
    GL_NAMED(GL_POINT_SPRITE),
    GL_NAMED(GL_PROGRAM_POINT_SIZE),
    GL_NAMED(GL_DITHER),
    GL_NAMED(GL_CLIP_PLANE0),
    GL_NAMED(GL_FOG),
    GL_NAMED(GL_LIGHTING),
    GL_NAMED(GL_DEPTH_BOUNDS_TEST_EXT),
    GL_NAMED(GL_FRAGMENT_PROGRAM_ARB),
};

/// For functions that libOSMesa does not export.
template <class Function>
Function entry_point(const char *name)
{
    const auto function = reinterpret_cast<Function>(OSMesaGetProcAddress(name));
    if (!function)
        finding("there is no {}", name);
    return function;
}

constexpr std::array<Named, 8> functions = {
    GL_NAMED(GL_LESS),  GL_NAMED(GL_LEQUAL),   GL_NAMED(GL_GREATER), GL_NAMED(GL_GEQUAL),
    GL_NAMED(GL_EQUAL), GL_NAMED(GL_NOTEQUAL), GL_NAMED(GL_ALWAYS),  GL_NAMED(GL_NEVER),
};

void enable(Machine &machine, Args &args)
{
    CALL(machine, glEnable, args.pick(capabilities));
}

void disable(Machine &machine, Args &args)
{
    CALL(machine, glDisable, args.pick(capabilities));
}

void depth_func(Machine &machine, Args &args)
{
    CALL(machine, glDepthFunc, functions[args.below(10) % 8]);
}

void depth_mask(Machine &machine, Args &args)
{
    CALL(machine, glDepthMask, args.below(4) > 0);
}

void color_mask(Machine &machine, Args &args)
{
    const unsigned mask = args.byte();
    const unsigned buffer = unsigned(args.below(9));
    const auto bit = [mask](int i) { return mask >> i & 1; };
    if (buffer == 8)
        CALL(machine, glColorMask, bit(0), bit(1), bit(2), bit(3));
    else
        CALL(machine, glColorMaski, buffer, bit(0), bit(1), bit(2), bit(3));
}

void clear_values(Machine &machine, Args &args)
{
    static constexpr std::array<double, 8> depths = {1.0, 0.0, 0.5, 0.75, 1e-30, 2.0, -1.0, 0.25};
    CALL(machine, glClearDepth, args.pick(depths));
    CALL(machine, glClearColor, args.unit(), args.unit(), 1.5F * args.unit() - 0.25F, args.unit());
    CALL(machine, glClearStencil, int(args.byte()));
}

void depth_range(Machine &machine, Args &args)
{
    const double near = args.unit(), far = args.unit();
    if (args.flag())
        CALL(machine, glDepthRangeIndexed, unsigned(args.below(2)), near, far);
    else
        CALL(machine, glDepthRange, near, far);
    static const auto depth_bounds = entry_point<PFNGLDEPTHBOUNDSEXTPROC>("glDepthBoundsEXT");
    if (args.below(8) == 7)
        machine.call("glDepthBoundsEXT", depth_bounds, near < far ? near : far,
                     near < far ? far : near);
}

void viewport(Machine &machine, Args &args)
{
    const int x = args.below(24) - 4, y = args.below(24) - 4;
    const int w = int(args.byte()) % 140, h = int(args.byte()) % 140;
    if (args.below(4) == 3)
        CALL(machine, glViewportIndexedf, unsigned(args.below(3)), float(x) + 0.5F, float(y),
             float(w), float(h));
    else
        CALL(machine, glViewport, x, y, w, h);
}

void scissor(Machine &machine, Args &args)
{
    CALL(machine, glScissor, args.below(40) - 4, args.below(40) - 4, args.below(70),
         args.below(70));
    CALL(machine, glEnable, GL_NAMED(GL_SCISSOR_TEST));
}

void stencil(Machine &machine, Args &args)
{
    static constexpr std::array<Named, 5> actions = {GL_NAMED(GL_KEEP), GL_NAMED(GL_REPLACE),
                                                     GL_NAMED(GL_INCR_WRAP), GL_NAMED(GL_INVERT),
                                                     GL_NAMED(GL_ZERO)};
    CALL(machine, glStencilFunc, args.pick(functions), int(args.byte()), 0xffU);
    CALL(machine, glStencilOp, args.pick(actions), args.pick(actions), args.pick(actions));
    CALL(machine, glStencilMask, args.byte());
}

void alpha_func(Machine &machine, Args &args)
{
    CALL(machine, glAlphaFunc, args.pick(functions), args.unit());
}

void blending(Machine &machine, Args &args)
{
    static constexpr std::array<Named, 7> factors = {
        GL_NAMED(GL_ONE),       GL_NAMED(GL_ZERO),       GL_NAMED(GL_SRC_ALPHA),
        GL_NAMED(GL_DST_ALPHA), GL_NAMED(GL_SRC1_COLOR), GL_NAMED(GL_ONE_MINUS_SRC_ALPHA),
        GL_NAMED(GL_DST_COLOR)};
    static constexpr std::array<Named, 4> equations = {GL_NAMED(GL_FUNC_ADD), GL_NAMED(GL_MIN),
                                                       GL_NAMED(GL_MAX),
                                                       GL_NAMED(GL_FUNC_REVERSE_SUBTRACT)};
    CALL(machine, glBlendFunc, args.pick(factors), args.pick(factors));
    CALL(machine, glBlendEquation, args.pick(equations));
    CALL(machine, glLogicOp, GLenum(GL_CLEAR) + unsigned(args.below(16)));
}

void polygons(Machine &machine, Args &args)
{
    static constexpr std::array<Named, 3> modes = {GL_NAMED(GL_FILL), GL_NAMED(GL_LINE),
                                                   GL_NAMED(GL_POINT)};
    CALL(machine, glPolygonMode, GL_NAMED(GL_FRONT_AND_BACK), args.pick(modes));
    CALL(machine, glPolygonOffset, float(args.below(9) - 4), float(args.below(9) - 4) * 1000.0F);
    CALL(machine, glLineWidth, 0.5F + float(args.below(8)));
    CALL(machine, glPointSize, 0.5F + float(args.below(20)));
    CALL(machine, glShadeModel, args.flag() ? GL_NAMED(GL_FLAT) : GL_NAMED(GL_SMOOTH));
    CALL(machine, glCullFace, args.flag() ? GL_NAMED(GL_FRONT) : GL_NAMED(GL_BACK));
}

void samples(Machine &machine, Args &args)
{
    CALL(machine, glSampleCoverage, args.unit(), args.flag());
    CALL(machine, glSampleMaski, 0U, args.byte());
    CALL(machine, glMinSampleShading, args.unit());
}

void conventions(Machine &machine, Args &args)
{
    static constexpr std::array<Named, 3> clamps = {GL_NAMED(GL_TRUE), GL_NAMED(GL_FALSE),
                                                    GL_NAMED(GL_FIXED_ONLY)};
    static const auto clip_control = entry_point<PFNGLCLIPCONTROLPROC>("glClipControl");
    const unsigned bits = args.byte();
    machine.call("glClipControl", clip_control,
                 bits & 1 ? GL_NAMED(GL_UPPER_LEFT) : GL_NAMED(GL_LOWER_LEFT),
                 bits & 2 ? GL_NAMED(GL_NEGATIVE_ONE_TO_ONE) : GL_NAMED(GL_ZERO_TO_ONE));
    CALL(machine, glProvokingVertex,
         bits & 4 ? GL_NAMED(GL_FIRST_VERTEX_CONVENTION) : GL_NAMED(GL_LAST_VERTEX_CONVENTION));
    CALL(machine, glClampColor, GL_NAMED(GL_CLAMP_FRAGMENT_COLOR), args.pick(clamps));
}

void sampling(Machine &machine, Args &args)
{
    const Texture &texture = machine.textures[std::size_t(args.below(Machine::texture_slots))];
    if (texture.name == 0)
        return;
    CALL(machine, glBindTexture, texture.target, texture.name);
    if (texture.target.value == GL_TEXTURE_2D || texture.target.value == GL_TEXTURE_3D)
        (args.flag() ? CALL(machine, glEnable, texture.target)
                     : CALL(machine, glDisable, texture.target));
}

void push_attrib(Machine &machine, Args &args)
{
    static constexpr std::array<unsigned, 4> masks = {GL_ALL_ATTRIB_BITS, GL_ENABLE_BIT,
                                                      GL_DEPTH_BUFFER_BIT | GL_COLOR_BUFFER_BIT,
                                                      GL_ENABLE_BIT | GL_VIEWPORT_BIT};
    CALL(machine, glPushAttrib, args.pick(masks));
}

void pop_attrib(Machine &machine, Args & /*args*/)
{
    CALL(machine, glPopAttrib);
}

void new_list(Machine &machine, Args &args)
{
    machine.open_list = args.below(3);
    CALL(machine, glNewList, machine.lists + unsigned(machine.open_list),
         args.flag() ? GL_NAMED(GL_COMPILE_AND_EXECUTE) : GL_NAMED(GL_COMPILE));
}

void end_list(Machine &machine, Args & /*args*/)
{
    machine.open_list = -1;
    CALL(machine, glEndList);
}

void call_list(Machine &machine, Args &args)
{
    CALL(machine, glCallList, machine.lists + unsigned(args.below(3)));
}

/// An open list belongs to its context.
void switch_context(Machine &machine, Args & /*args*/)
{
    machine.switch_context();
}

void flush(Machine &machine, Args &args)
{
    if (args.flag())
        CALL(machine, glFinish);
    else
        CALL(machine, glFlush);
}

/// The queries of the extensions' state, in all types.
void get_state(Machine &machine, Args &args)
{
    static constexpr std::array<Named, 4> names = {
        GL_NAMED(GL_DEPTH_PEELING_MESA), GL_NAMED(GL_KBUFFER_PROGRAM_MESA),
        GL_NAMED(GL_MAX_DEPTH_PEELING_LAYERS_MESA), GL_NAMED(GL_MAX_KBUFFER_ENTRIES_MESA)};
    const Named name = args.pick(names);
    GLfloat real = 0.0F;
    GLboolean truth = GL_FALSE;
    CALL(machine, glGetFloatv, name, &real);
    CALL(machine, glGetBooleanv, name, &truth);
}

constexpr unsigned any_error =
    invalid_enum | invalid_value | invalid_operation | invalid_framebuffer | stack_error;

constexpr std::array<Command, 24> commands{{
    {"enable", enable, invalid_enum, true, 4},
    {"disable", disable, invalid_enum, true, 4},
    {"depth_func", depth_func, no_error, true, 3},
    {"depth_mask", depth_mask, no_error, true},
    {"color_mask", color_mask, no_error, true},
    {"clear_values", clear_values, no_error, true, 2},
    {"depth_range", depth_range, invalid_operation, true},
    {"viewport", viewport, no_error, true},
    {"scissor", scissor, no_error, true},
    {"stencil", stencil, no_error, true},
    {"alpha_func", alpha_func, no_error, true},
    {"blending", blending, no_error, true},
    {"polygons", polygons, no_error, true},
    {"samples", samples, invalid_operation, true},
    {"conventions", conventions, invalid_operation, true},
    {"sampling", sampling, invalid_operation},
    {"push_attrib", push_attrib, stack_error, true},
    {"pop_attrib", pop_attrib, stack_error, true},
    {"new_list", new_list, invalid_operation},
    {"end_list", end_list, any_error, true, 2},
    {"call_list", call_list, any_error, true},
    {"switch_context", switch_context, no_error, false, 2},
    {"flush", flush, no_error, true},
    {"get_state", get_state, no_error, true},
}};

} // namespace

std::span<const Command> state_commands()
{
    return commands;
}

} // namespace kb::fuzz
