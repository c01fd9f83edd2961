// SPDX-License-Identifier: MIT

#include "tests/programs/arb_interpreter.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <sstream>

namespace kb::test
{

namespace
{

[[noreturn]] void refuse(const std::string &what)
{
    throw std::runtime_error("not in the subset: " + what);
}

int component_index(char c)
{
    const auto index = std::string("xyzw").find(c);
    if (index == std::string::npos)
        refuse(std::string("component ") + c);
    return static_cast<int>(index);
}

std::string strip(const std::string &text)
{
    const auto first = text.find_first_not_of(" \t\n");
    if (first == std::string::npos)
        return {};
    return text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
}

/// "name[3]" at the front of the text: returns 3 and leaves what follows.
std::size_t take_entry(std::string &text, const std::string &prefix)
{
    std::size_t used = 0;
    const std::size_t entry = std::stoul(text.substr(prefix.size() + 1), &used);
    if (text.at(prefix.size()) != '[' || text.at(prefix.size() + 1 + used) != ']')
        refuse(text);
    text = text.substr(prefix.size() + 2 + used);
    return entry;
}

/// PK4UB of the extension's text.
float pack_bytes(const glm::vec4 &v)
{
    std::uint32_t bits = 0;
    for (int c = 0; c < 4; ++c) {
        const float clamped = v[c] > 0.0F ? std::min(v[c], 1.0F) : 0.0F;
        bits |= static_cast<std::uint32_t>(std::lround(255.0F * clamped)) << (8 * c);
    }
    return std::bit_cast<float>(bits);
}

} // namespace

ArbInterpreter::ArbInterpreter(const std::string &program)
{
    std::istringstream lines(program);
    std::string line;
    std::string body;
    std::getline(lines, line);
    if (line != "!!ARBfp1.0")
        refuse(line);
    while (std::getline(lines, line))
        body += line.substr(0, line.find('#')) + "\n";

    std::istringstream statements(body);
    std::string statement;
    bool option = false;
    bool ended = false;
    while (std::getline(statements, statement, ';')) {
        statement = strip(statement);
        if (ended)
            refuse("text behind END");
        if (statement == "END")
            ended = true;
        else if (statement == "OPTION MESA_kbuffer_program")
            option = true;
        else if (statement.starts_with("TEMP ")) {
            std::istringstream names(statement.substr(5));
            for (std::string name; std::getline(names, name, ',');)
                temporaries_[strip(name)] = static_cast<int>(temporaries_.size());
        } else
            instructions_.push_back(parse_instruction(statement));
    }
    if (!option || !ended)
        refuse("a program without its option or END");
}

ArbInterpreter::Operand ArbInterpreter::parse_operand(std::string text,
                                                      const std::map<std::string, int> &temporaries)
{
    Operand operand;
    if (text.starts_with('-')) {
        operand.negate = true;
        text = text.substr(1);
    }
    if (std::isdigit(static_cast<unsigned char>(text.at(0)))) {
        operand.name = "constant";
        operand.value = std::stof(text);
        return operand;
    }
    if (text.starts_with("fragment.color") || text.starts_with("fragment.position")) {
        operand.name = text.starts_with("fragment.color") ? "color" : "position";
        text = text.substr(std::string("fragment.").size() + operand.name.size());
    } else if (text.starts_with("kbuffer")) {
        operand.name = "kbuffer";
        operand.entry = take_entry(text, "kbuffer");
    } else {
        operand.name = text.substr(0, text.find('.'));
        if (!temporaries.contains(operand.name))
            refuse(text);
        text = text.substr(operand.name.size());
    }
    if (text.empty())
        return operand;
    if (text.size() != 2 && text.size() != 5)
        refuse("swizzle " + text);
    for (std::size_t c = 0; c < 4; ++c)
        operand.swizzle[c] = component_index(text.size() == 2 ? text[1] : text[1 + c]);
    return operand;
}

ArbInterpreter::Instruction ArbInterpreter::parse_instruction(const std::string &statement) const
{
    static const std::map<std::string, std::size_t> source_counts{
        {"MOV", 1}, {"PK4UB", 1}, {"RCP", 1}, {"SGE", 2}, {"SLT", 2}, {"SUB", 2},
        {"MUL", 2}, {"MIN", 2},   {"MAX", 2}, {"CMP", 3}, {"MAD", 3}, {"KIL", 1},
    };
    Instruction instruction;
    instruction.opcode = statement.substr(0, statement.find(' '));
    if (!source_counts.contains(instruction.opcode))
        refuse(statement);

    std::vector<std::string> operands;
    std::istringstream list(statement.substr(instruction.opcode.size()));
    for (std::string text; std::getline(list, text, ',');)
        operands.push_back(strip(text));

    std::size_t first_source = 0;
    if (instruction.opcode != "KIL") {
        first_source = 1;
        std::string text = operands.at(0);
        if (text.starts_with("result.kbuffer")) {
            instruction.destination.name = "result";
            instruction.destination.entry = take_entry(text, "result.kbuffer");
        } else {
            instruction.destination.name = text.substr(0, text.find('.'));
            if (!temporaries_.contains(instruction.destination.name))
                refuse(statement);
            text = text.substr(instruction.destination.name.size());
        }
        if (!text.empty()) {
            std::fill_n(instruction.mask, 4, false);
            int last = -1;
            for (const char c : text.substr(1)) {
                if (component_index(c) <= last)
                    refuse("write mask " + text);
                last = component_index(c);
                instruction.mask[last] = true;
            }
        }
    }
    for (std::size_t i = first_source; i < operands.size(); ++i)
        instruction.sources.push_back(parse_operand(operands[i], temporaries_));
    if (instruction.sources.size() != source_counts.at(instruction.opcode))
        refuse(statement);
    return instruction;
}

bool ArbInterpreter::run(const Fragment &fragment, std::vector<glm::vec4> &kbuffer) const
{
    std::map<std::string, glm::vec4> temporaries;
    std::vector<glm::vec4> result = kbuffer;

    const auto read = [&](const Operand &operand) {
        glm::vec4 value(operand.value);
        if (operand.name == "color")
            value = fragment.color;
        else if (operand.name == "position")
            value = glm::vec4(0.5F, 0.5F, fragment.depth, 1.0F);
        else if (operand.name == "kbuffer")
            value = kbuffer.at(operand.entry);
        else if (operand.name != "constant")
            // An undefined temporary is a mistake where it matters: NaN shows it.
            value = temporaries.try_emplace(operand.name, glm::vec4(NAN)).first->second;
        glm::vec4 swizzled;
        for (int c = 0; c < 4; ++c) {
            const float component = value[operand.swizzle[c]];
            swizzled[c] = operand.negate ? -component : component;
        }
        return swizzled;
    };

    for (const Instruction &instruction : instructions_) {
        glm::vec4 s[3];
        for (std::size_t i = 0; i < instruction.sources.size(); ++i)
            s[i] = read(instruction.sources[i]);
        if (instruction.opcode == "KIL") {
            for (int c = 0; c < 4; ++c) {
                if (s[0][c] < 0.0F)
                    return false;
            }
            continue;
        }
        glm::vec4 value = s[0];
        if (instruction.opcode == "PK4UB")
            value = glm::vec4(pack_bytes(s[0]));
        for (int c = 0; c < 4; ++c) {
            if (instruction.opcode == "SGE")
                value[c] = s[0][c] >= s[1][c] ? 1.0F : 0.0F;
            else if (instruction.opcode == "SLT")
                value[c] = s[0][c] < s[1][c] ? 1.0F : 0.0F;
            else if (instruction.opcode == "SUB")
                value[c] = s[0][c] - s[1][c];
            else if (instruction.opcode == "MUL")
                value[c] = s[0][c] * s[1][c];
            else if (instruction.opcode == "MAD")
                value[c] = s[0][c] * s[1][c] + s[2][c];
            else if (instruction.opcode == "RCP")
                value[c] = 1.0F / s[0][c];
            else if (instruction.opcode == "MIN")
                value[c] = std::min(s[0][c], s[1][c]);
            else if (instruction.opcode == "MAX")
                value[c] = std::max(s[0][c], s[1][c]);
            else if (instruction.opcode == "CMP")
                value[c] = s[0][c] < 0.0F ? s[1][c] : s[2][c];
        }
        const Operand &to = instruction.destination;
        glm::vec4 &target = to.name == "result"
                                ? result.at(to.entry)
                                : temporaries.try_emplace(to.name, glm::vec4(NAN)).first->second;
        for (int c = 0; c < 4; ++c) {
            if (instruction.mask[c])
                target[c] = value[c];
        }
    }
    kbuffer = result;
    return true;
}

} // namespace kb::test
