// SPDX-License-Identifier: MIT

#include "fuzz/draws/programs.hpp"

#include <array>

namespace kb::fuzz
{

#define KBUFFER_HEAD "!!ARBfp1.0\nOPTION MESA_kbuffer_program;\n"

std::span<const KbufferText> kbuffer_texts()
{
    static const std::vector<KbufferText> texts = {
        {KBUFFER_HEAD "ADD result.kbuffer[0], kbuffer[0], fragment.color;\nEND\n", {0}},
        {KBUFFER_HEAD "TEMP t, u, n;\n"
                      "SLT t, fragment.position.z, kbuffer[1].w;\nSUB t, t, 0.5;\nKIL t;\n"
                      "MOV u, fragment.color;\nMOV u.w, fragment.position.z;\n"
                      "SLT n, fragment.position.z, kbuffer[0].w;\n"
                      "CMP result.kbuffer[0], -n, u, kbuffer[0];\n"
                      "CMP result.kbuffer[1], -n, kbuffer[0], u;\nEND\n",
         {0, 1}},
        {KBUFFER_HEAD "MOV result.kbuffer[0].y, program.local[0];\n"
                      "PK4UB result.kbuffer[2].x, fragment.color[1];\n"
                      "UP4UB result.kbuffer[1], kbuffer[2].x;\nEND\n",
         {0, 1, 2}},
        {KBUFFER_HEAD "MOV result.kbuffer[63], kbuffer[0];\nEND\n", {0, 63}},
        {KBUFFER_HEAD "TEMP t;\nTEX t, fragment.position, texture[0], 2D;\n"
                      "MAD result.kbuffer[0].xw, t, program.env[1], kbuffer[3];\nEND\n",
         {0, 3}},
        {KBUFFER_HEAD "KIL -1;\nMOV result.kbuffer[0], 7;\nEND\n", {0}, true, true},
        {KBUFFER_HEAD "END\n", {}},
        {KBUFFER_HEAD "MOV result.kbuffer[5], fragment.position;\n"
                      "RCP result.kbuffer[7].z, kbuffer[7].x;\nEND\n",
         {5, 7}},
        {KBUFFER_HEAD "MOV result.kbuffer[64], 1;\nEND\n", {}, false},
        {"!!ARBfp1.0\nMOV result.color, 1;\nEND\n", {}, false},
    };
    return texts;
}

std::string_view vertex_shader()
{
    return "#version 150 compatibility\n"
           "out vec4 color;\nflat out int id;\n"
           "void main() { gl_Position = ftransform(); color = gl_Color; id = gl_VertexID;\n"
           "  gl_PointSize = 3.0; gl_ClipVertex = gl_ModelViewMatrix * gl_Vertex; }\n";
}

#define FRAGMENT_HEAD "#version 150 compatibility\nin vec4 color;\nflat in int id;\n"

std::span<const FragmentStage> fragment_stages()
{
    static constexpr std::array<FragmentStage, 13> stages{{
        {"", FRAGMENT_HEAD "void main() { for (int i = 0; i < 8; ++i)"
                           " gl_FragData[i] = color * float(i + 1) * 0.125; }\n"},
        {"", FRAGMENT_HEAD "void main() { if (fract(gl_FragCoord.x * 0.3) > 0.5) discard;"
                           " gl_FragColor = color; }\n"},
        {"", FRAGMENT_HEAD "void main() { gl_FragDepth = fract(color.r * 7.0 + gl_FragCoord.y);"
                           " gl_FragColor = color; }\n"},
        // Depths that are not numbers, or not in the range.
        {"", FRAGMENT_HEAD "void main() { gl_FragDepth = id % 3 == 0 ? 0.0 / (color.b - color.b) :"
                           " id % 3 == 1 ? -1.0 / (color.b - color.b) : 3.0 * color.b - 1.0;"
                           " gl_FragColor = color / color.a; }\n"},
        {"", FRAGMENT_HEAD "out ivec4 c;\nvoid main() { c = ivec4(color * 1e9) + id; }\n", true},
        {"", FRAGMENT_HEAD "out uvec4 c;\nvoid main() { c = uvec4(id); }\n", true},
        {"#version 150 compatibility\n"
         "layout(triangles) in;\nlayout(triangle_strip, max_vertices = 6) out;\n"
         "in vec4 color[];\nflat in int id[];\nout vec4 colour;\nflat out int name;\n"
         "void main() { for (int layer = 0; layer < 2; ++layer) { for (int i = 0; i < 3; ++i) {\n"
         "  gl_Position = gl_in[i].gl_Position; colour = color[i]; name = id[i];\n"
         "  gl_Layer = 3 * layer; gl_PrimitiveID = layer; EmitVertex(); } EndPrimitive(); } }\n",
         "#version 150 compatibility\nin vec4 colour;\nflat in int name;\n"
         "void main() { gl_FragColor = colour + float(name); }\n"},
        {"#version 150 compatibility\n#extension GL_ARB_viewport_array : require\n"
         "layout(triangles) in;\nlayout(line_strip, max_vertices = 3) out;\n"
         "in vec4 color[];\nout vec4 colour;\n"
         "void main() { for (int i = 0; i < 3; ++i) { gl_Position = gl_in[i].gl_Position;\n"
         "  colour = color[i]; gl_ViewportIndex = gl_PrimitiveIDIn & 1; EmitVertex(); } }\n",
         "#version 150 compatibility\nin vec4 colour;\nvoid main() { gl_FragColor = colour; }\n"},
        {"", FRAGMENT_HEAD "#extension GL_ARB_sample_shading : require\n"
                           "void main() { gl_FragColor = color * float(gl_SampleID + 1); }\n"},
        {"",
         "#version 420 compatibility\nin vec4 color;\n"
         "layout(binding = 0, offset = 0) uniform atomic_uint counter;\n"
         "void main() { gl_FragColor = color * float(atomicCounterIncrement(counter)); }\n",
         false, true},
        {"",
         "#version 430 compatibility\nin vec4 color;\nflat in int id;\n"
         "layout(std430, binding = 0) buffer Store { uint stored[]; };\n"
         "void main() { atomicAdd(stored[id & 15], 1u); gl_FragColor = color;\n"
         "  gl_FragDepth = color.g; if (id % 5 == 0) discard; }\n",
         false, true},
        {"", "#version 420 compatibility\nin vec4 color;\n"
             "layout(early_fragment_tests) in;\nlayout(depth_greater) out float gl_FragDepth;\n"
             "void main() { gl_FragColor = color; gl_FragDepth = gl_FragCoord.z + 0.1; }\n"},
        {"", "#version 330 compatibility\nin vec4 color;\n"
             "layout(location = 0, index = 0) out vec4 a;\nlayout(location = 0, index = 1) out "
             "vec4 b;\n"
             "void main() { a = color; b = color.wzyx; }\n"},
    }};
    return stages;
}

} // namespace kb::fuzz
