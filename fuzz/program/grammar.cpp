// SPDX-License-Identifier: MIT

#include "fuzz/program/grammar.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace kb::fuzz
{

namespace
{

/// Few names, so that uses meet declarations, and declarations each other.
constexpr std::array<std::string_view, 6> names = {"t", "u", "v", "p", "a", "o"};

constexpr std::array<std::string_view, 13> states = {
    "state.material.ambient",
    "state.light[0].diffuse",
    "state.light[7].half",
    "state.lightprod[0].specular",
    "state.lightmodel.scenecolor",
    "state.fog.color",
    "state.fog.params",
    "state.depth.range",
    "state.texenv[0].color",
    "state.matrix.modelview[0].row[1]",
    "state.matrix.mvp.transpose.row[3]",
    "state.matrix.texture[1].inverse.row[0]",
    "state.matrix.program[2].invtrans.row[2]",
};

/// Indices about the limits, too.
std::string random_index(Random &random)
{
    static constexpr std::array<std::string_view, 8> limits = {
        "7", "8", "63", "64", "95", "96", "4294967296", "99999999999999999999"};
    if (random.one_in(12))
        return std::string(random.pick(limits));
    return std::to_string(random.below(random.one_in(4) ? 64 : 4));
}

std::string random_number(Random &random)
{
    static constexpr std::array<std::string_view, 12> numbers = {
        "0",   "1",    "0.5",    "2",     "255.0",  ".25",
        "1e3", "1e-9", "3.4e38", "1e-45", "1e9999", "0.00390625"};
    return std::string(random.pick(numbers));
}

std::string random_vector(Random &random)
{
    std::string text = "{";
    const std::size_t count = 1 + random.below(4);
    for (std::size_t i = 0; i < count; ++i)
        text += fmt::format("{}{}{}", i ? ", " : "", random.one_in(3) ? "-" : "",
                            random_number(random));
    return text + "}";
}

std::string random_parameter(Random &random)
{
    switch (random.below(4)) {
    case 0:
        return fmt::format("program.env[{}]", random_index(random));
    case 1:
        return fmt::format("program.local[{}]", random_index(random));
    case 2:
        return std::string(random.pick(states));
    default:
        return random.one_in(2) ? random_vector(random) : random_number(random);
    }
}

std::string random_swizzle(Random &random, bool scalar)
{
    static constexpr std::array<std::string_view, 2> components = {"xyzw", "rgba"};
    const std::string_view set = components[random.one_in(4)];
    const std::size_t count = scalar || random.one_in(3) ? 1 : random.one_in(2) ? 4 : 0;
    std::string text = count ? "." : "";
    for (std::size_t i = 0; i < count; ++i)
        text += set[random.below(4)];
    return text;
}

std::string random_operand(Random &random, bool scalar)
{
    return (random.one_in(4) ? "-" : "") + random_source(random) + random_swizzle(random, scalar);
}

std::string random_mask(Random &random)
{
    static constexpr std::string_view components = "xyzw";
    const std::size_t mask = random.one_in(2) ? 15 : 1 + random.below(15);
    std::string text = mask == 15 ? "" : ".";
    for (std::size_t i = 0; mask != 15 && i < 4; ++i)
        if (mask >> i & 1)
            text += components[i];
    return text;
}

/// Opcode, and the kinds of its operands: s(calar), v(ector), t(exture).
struct Instruction {
    std::string_view opcode, operands;
    bool writes = true;
};

constexpr std::array<Instruction, 34> instructions{{
    {"ABS", "v"},  {"FLR", "v"},   {"FRC", "v"},        {"LIT", "v"},   {"MOV", "v"},
    {"SWZ", "v"},  {"COS", "s"},   {"EX2", "s"},        {"LG2", "s"},   {"RCP", "s"},
    {"RSQ", "s"},  {"SIN", "s"},   {"SCS", "s"},        {"POW", "ss"},  {"ADD", "vv"},
    {"DP3", "vv"}, {"DP4", "vv"},  {"DPH", "vv"},       {"DST", "vv"},  {"MAX", "vv"},
    {"MIN", "vv"}, {"MUL", "vv"},  {"SGE", "vv"},       {"SLT", "vv"},  {"SUB", "vv"},
    {"XPD", "vv"}, {"CMP", "vvv"}, {"LRP", "vvv"},      {"MAD", "vvv"}, {"TEX", "vt"},
    {"TXB", "vt"}, {"TXP", "vt"},  {"KIL", "v", false}, {"PK4UB", "v"},
}};

std::string random_instruction(Random &random)
{
    static constexpr Instruction unpack = {"UP4UB", "s"};
    static constexpr std::array<std::string_view, 7> textures = {
        "1D", "2D", "3D", "CUBE", "RECT", "SHADOW2D", "ARRAY2D"};
    const Instruction &instruction = random.one_in(16) ? unpack : random.pick(instructions);

    std::string text(instruction.opcode);
    if (instruction.writes) {
        text += random.one_in(6) ? "_SAT " : " ";
        text += random_destination(random) + random_mask(random) + ", ";
    } else {
        text += ' ';
    }
    bool first = true;
    for (const char kind : instruction.operands) {
        text += first ? "" : ", ";
        first = false;
        if (kind == 't')
            text += fmt::format("texture[{}], {}", random.below(2), random.pick(textures));
        else
            text += random_operand(random, kind == 's');
    }
    if (instruction.opcode == "SWZ")
        text += ", x, 0, -y, 1";
    return text + ";";
}

std::string random_array(Random &random, std::string_view name)
{
    if (random.one_in(2))
        return fmt::format("PARAM {}[{}] = {{ program.{}[{}..{}] }};", name, random.below(5),
                           random.one_in(2) ? "env" : "local", random.below(3),
                           random_index(random));
    return fmt::format("PARAM {}[] = {{ {}, {} }};", name, random_parameter(random),
                       random_parameter(random));
}

std::string random_declaration(Random &random)
{
    const std::string_view name = random.pick(names);
    switch (random.below(6)) {
    case 0:
        return fmt::format("PARAM {} = {};", name, random_parameter(random));
    case 1:
        return fmt::format("ATTRIB {} = {};", name, random_source(random));
    case 2:
        return fmt::format("OUTPUT {} = {};", name, random_destination(random));
    case 3:
        return fmt::format("ALIAS {} = {};", name, random.pick(names));
    case 4:
        return random_array(random, name);
    default:
        return fmt::format("TEMP {}, {};", name, random.pick(names));
    }
}

} // namespace

std::string random_source(Random &random)
{
    switch (random.below(8)) {
    case 0:
        return "fragment.color";
    case 1:
        return fmt::format("fragment.color[{}]", random_index(random));
    case 2:
        return "fragment.position";
    case 3:
    case 4:
        return fmt::format("kbuffer[{}]", random_index(random));
    case 5:
        return random_parameter(random);
    default:
        return std::string(random.pick(names));
    }
}

std::string random_destination(Random &random)
{
    if (random.one_in(2))
        return fmt::format("result.kbuffer[{}]", random_index(random));
    return std::string(random.pick(names));
}

std::string random_statement(Random &random)
{
    return random.one_in(4) ? random_declaration(random) : random_instruction(random);
}

} // namespace kb::fuzz
