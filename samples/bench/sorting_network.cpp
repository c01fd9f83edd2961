// SPDX-License-Identifier: MIT

#include "sorting_network.hpp"

#include "background.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace kb::bench
{

namespace
{

class SortSource
{
public:
    SortSource(int slots, std::string_view load) : slots_(slots), load_(load) {}

    std::string write()
    {
        for (int slot = 0; slot < slots_; ++slot)
            text_ += fmt::format("    float z{0} = 1.0 / 0.0;\n    uint color{0} = 0u;\n", slot);
        sort(0, static_cast<int>(std::bit_ceil(static_cast<unsigned>(slots_))));
        return text_;
    }

private:
    // Where there are fewer slots than the power of two, the missing ones would be behind all
    // others and stay there: what compares with them is left out.
    void sort(int first, int count)
    {
        if (first >= slots_)
            return;
        if (count == 1) {
            text_ += fmt::format("    if (count > {}) {{\n        ", first);
            text_ += fmt::format(fmt::runtime(load_), first);
            text_ += "\n    }\n";
            return;
        }
        const int half = count / 2;
        sort(first, half);
        if (first + half >= slots_)
            return;
        text_ += fmt::format("    if (count > {}) {{\n", first + half);
        sort(first + half, half);
        merge(first, count, 1);
        text_ += "    }\n";
    }

    void merge(int first, int count, int step)
    {
        const int next = step * 2;
        if (next >= count) {
            order(first, first + step);
            return;
        }
        merge(first, count, next);
        merge(first + step, count, next);
        for (int slot = first + step; slot + step < first + count; slot += next)
            order(slot, slot + step);
    }

    void order(int near, int far)
    {
        if (far < slots_)
            text_ += fmt::format("    ORDER({}, {})\n", near, far);
    }

    int slots_;
    std::string_view load_;
    std::string text_;
};

} // namespace

std::string load_sorted_glsl(int slots, std::string_view load)
{
    return R"(
#define ORDER(near, far) { \
        bool wrong = z##far < z##near; \
        float z = max(z##near, z##far); \
        uint color = wrong ? color##near : color##far; \
        z##near = min(z##near, z##far); \
        color##near = wrong ? color##far : color##near; \
        z##far = z; \
        color##far = color; \
    }
)" + SortSource(slots, load).write();
}

std::string composite_sorted_glsl(int slots)
{
    constexpr int group = 4;
    std::string text = "    vec3 sum = vec3(0.0);\n    float transmittance = 1.0;\n";
    for (int first = 0; first < slots; first += group) {
        text += fmt::format("    if (count > {}) {{\n", first);
        for (int slot = first; slot < std::min(first + group, slots); ++slot)
            text += fmt::format("        {{\n"
                                "            vec4 fragment = unpackUnorm4x8(color{});\n"
                                "            sum += transmittance * fragment.a * fragment.rgb;\n"
                                "            transmittance *= 1.0 - fragment.a;\n"
                                "        }}\n",
                                slot);
        text += "    }\n";
    }
    return text +
           fmt::format("    color = vec4(sum + transmittance * {}, 1.0);\n", background_glsl());
}

} // namespace kb::bench
