// SPDX-License-Identifier: MIT

#include "bench/sorting_network.hpp"

#include "bench/background.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace kb::bench
{

namespace
{

/// Exchanges two slots if they are in the wrong order.
std::string order(int near, int far)
{
    return fmt::format("    {{ bool wrong = z{1} < z{0} || (z{1} == z{0} && item{1} < item{0});"
                       " float z = max(z{0}, z{1}); uint item = wrong ? item{0} : item{1};"
                       " z{0} = min(z{0}, z{1}); item{0} = wrong ? item{1} : item{0};"
                       " z{1} = z; item{1} = item; }}\n",
                       near, far);
}

class SortSource
{
public:
    SortSource(int first, int count, std::string_view filled, std::string_view load)
        : begin_(first), end_(first + count), filled_(filled), load_(load)
    {
    }

    std::string write()
    {
        sort(begin_, static_cast<int>(std::bit_ceil(static_cast<unsigned>(end_ - begin_))));
        return text_;
    }

private:
    // Where there are fewer slots than the power of two, the missing ones would be behind all
    // others and stay there: what compares with them is left out.
    void sort(int first, int count)
    {
        if (first >= end_)
            return;
        if (count == 1) {
            begin_if_filled(first);
            text_ += fmt::format(fmt::runtime(load_), first, first - begin_);
            text_ += "\n    }\n";
            return;
        }
        const int half = count / 2;
        sort(first, half);
        if (first + half >= end_)
            return;
        begin_if_filled(first + half);
        sort(first + half, half);
        merge(first, count, 1);
        text_ += "    }\n";
    }

    void merge(int first, int count, int step)
    {
        const int next = step * 2;
        if (next >= count) {
            order_slots(first, first + step);
            return;
        }
        merge(first, count, next);
        merge(first + step, count, next);
        for (int slot = first + step; slot + step < first + count; slot += next)
            order_slots(slot, slot + step);
    }

    // merge() recurses into every second slot, so first + count may be past the end of the run:
    // what it compares never is.
    void order_slots(int near, int far)
    {
        if (far < end_)
            text_ += order(near, far);
    }

    void begin_if_filled(int slot)
    {
        text_ += fmt::format("    if ({} > {}) {{\n", filled_, slot - begin_);
    }

    int begin_;
    int end_;
    std::string_view filled_;
    std::string_view load_;
    std::string text_;
};

} // namespace

std::string declare_slots_glsl(int first, int count)
{
    std::string text;
    for (int slot = first; slot < first + count; ++slot)
        text += fmt::format("    float z{0} = 1.0 / 0.0;\n    uint item{0} = ~0u;\n", slot);
    return text;
}

std::string load_sorted_glsl(int first, int count, std::string_view filled, std::string_view load)
{
    return SortSource(first, count, filled, load).write();
}

std::string merge_nearest_glsl(int count)
{
    // The first run ascends and the second, read backwards, descends: of each pair the nearer one
    // stays, and these are a bitonic run.
    std::string text;
    for (int slot = 0; slot < count; ++slot)
        text += order(slot, 2 * count - 1 - slot);
    for (int step = count / 2; step > 0; step /= 2)
        for (int slot = 0; slot < count; ++slot)
            if ((slot & step) == 0)
                text += order(slot, slot + step);
    return text;
}

std::string composite_sorted_glsl(int count, std::string_view filled, std::string_view item_color)
{
    constexpr int group = 4;
    std::string text = "    vec3 sum = vec3(0.0);\n    float transmittance = 1.0;\n";
    for (int first = 0; first < count; first += group) {
        text += fmt::format("    if ({} > {}) {{\n", filled, first);
        for (int slot = first; slot < std::min(first + group, count); ++slot)
            text += fmt::format("        if ({} > {}) {{\n"
                                "            vec4 fragment = unpackUnorm4x8({});\n"
                                "            sum += transmittance * fragment.a * fragment.rgb;\n"
                                "            transmittance *= 1.0 - fragment.a;\n"
                                "        }}\n",
                                filled, slot, fmt::format(fmt::runtime(item_color), slot));
        text += "    }\n";
    }
    return text +
           fmt::format("    color = vec4(sum + transmittance * {}, 1.0);\n", background_glsl());
}

} // namespace kb::bench
