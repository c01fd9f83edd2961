// SPDX-License-Identifier: MIT
//
// Runs the subset of ARB_fragment_program with MESA_kbuffer_program that insertion programs use,
// for one fragment, on the CPU. Written from the extension's text alone, as a check on programs
// without a driver.

#pragma once

#include <glm/vec4.hpp>

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace kb::test
{

struct Fragment {
    glm::vec4 color{};
    float depth = 0.0F;
};

class ArbInterpreter
{
public:
    /// Throws std::runtime_error with the line for what is not in the subset.
    explicit ArbInterpreter(const std::string &program);

    /// Runs the program once. Returns whether the fragment got to the end.
    bool run(const Fragment &fragment, std::vector<glm::vec4> &kbuffer) const;

    std::size_t instruction_count() const { return instructions_.size(); }

private:
    struct Operand {
        std::string name; ///< A temporary, "color", "position", "kbuffer" or "constant".
        std::size_t entry = 0;
        float value = 0.0F;
        bool negate = false;
        int swizzle[4] = {0, 1, 2, 3};
    };
    struct Instruction {
        std::string opcode;
        Operand destination; ///< Its name is "result" for an entry.
        bool mask[4] = {true, true, true, true};
        std::vector<Operand> sources;
    };

    static Operand parse_operand(std::string text, const std::map<std::string, int> &temporaries);
    Instruction parse_instruction(const std::string &statement) const;

    std::map<std::string, int> temporaries_;
    std::vector<Instruction> instructions_;
};

} // namespace kb::test
