// SPDX-License-Identifier: MIT
//
// With the old fragments z[0] <= z[1] <= ..., p[i] = (z < z[i]) is false up to the place of the new
// fragment and true behind it. So
//
//     new[i] = p[i-1] ? old[i-1] : p[i] ? fragment : old[i]
//
// An insertion by swaps on z < z[i] would not do: an element that was pushed out of its place could
// overtake others of the same depth. CMP tests for less than zero: hence -p. It moves bits, so
// packed colors pass.

#include "programs/kbuffer_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

namespace kb
{

namespace
{

struct LayoutFacts {
    EntryLayout layout;
    std::string_view name;
    int fragments_per_entry;
    std::string_view depths; ///< The component with the depth of each fragment of an entry.
    std::string_view meaning;
};

constexpr std::array<LayoutFacts, 4> all_layouts{{
    {EntryLayout::rgbz, "rgbz", 1, "w", "red, green, blue, depth"},
    {EntryLayout::packed, "packed", 2, "yw", "RGBA8, depth, RGBA8, depth"},
    {EntryLayout::depth, "depth", 1, "x", "depth"},
    {EntryLayout::depth4, "depth4", 4, "xyzw", "four depths"},
}};

const LayoutFacts &facts(EntryLayout layout)
{
    return *std::find_if(all_layouts.begin(), all_layouts.end(),
                         [layout](const LayoutFacts &f) { return f.layout == layout; });
}

/// Collects the lines of a program.
class Listing
{
public:
    template <class... Args>
    void line(fmt::format_string<Args...> format, Args &&...args)
    {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
        text_ += '\n';
    }

    const std::string &text() const { return text_; }

private:
    std::string text_;
};

/// Ends the program for fragments that do not come before the last one: also for NaN.
void reject(Listing &out, EntryLayout layout, int k)
{
    const int per_entry = fragments_per_entry(layout);
    const char component = facts(layout).depths[std::size_t((k - 1) % per_entry)];
    out.line("SLT t.x, fragment.position.z, kbuffer[{}].{};", (k - 1) / per_entry, component);
    out.line("SUB t.x, t.x, 0.5;");
    out.line("KIL t.x;");
}

void insert_rgbz(Listing &out, int k)
{
    out.line("TEMP t, new, p;");
    reject(out, EntryLayout::rgbz, k);
    out.line("MOV new.xyz, fragment.color;");
    out.line("MOV new.w, fragment.position.z;");
    // p.x and p.y hold p[i] and p[i-1] in turn.
    for (int i = 0; i < k; ++i) {
        const char here = i % 2 == 0 ? 'x' : 'y';
        const char before = i % 2 == 0 ? 'y' : 'x';
        out.line("SLT p.{}, fragment.position.z, kbuffer[{}].w;", here, i);
        if (i == 0) {
            out.line("CMP result.kbuffer[0], -p.x, new, kbuffer[0];");
        } else {
            out.line("CMP t, -p.{}, new, kbuffer[{}];", here, i);
            out.line("CMP result.kbuffer[{}], -p.{}, kbuffer[{}], t;", i, before, i - 1);
        }
    }
}

void insert_packed(Listing &out, int k)
{
    out.line("TEMP t, new, p0, p1;");
    reject(out, EntryLayout::packed, k);
    out.line("PK4UB new.xz, fragment.color;");
    out.line("MOV new.yw, fragment.position.z;");
    // Fragments 2e and 2e + 1 are in .xy and .zw of entry e. p0 and p1 hold the four predicates of
    // an entry (each twice: for color and depth) in turn.
    for (int e = 0; e < entry_count(EntryLayout::packed, k); ++e) {
        const char *here = e % 2 == 0 ? "p0" : "p1";
        const char *before = e % 2 == 0 ? "p1" : "p0";
        out.line("SLT {}, fragment.position.z, kbuffer[{}].yyww;", here, e);
        out.line("CMP t, -{}, new, kbuffer[{}];", here, e);
        if (e == 0)
            out.line("MOV result.kbuffer[0].xy, t;");
        else
            out.line("CMP result.kbuffer[{}].xy, -{}.w, kbuffer[{}].zwzw, t;", e, before, e - 1);
        if (2 * e + 1 < k)
            out.line("CMP result.kbuffer[{}].zw, -{}.x, kbuffer[{}].xyxy, t;", e, here, e);
    }
}

/// Depth alone needs no predicates: new[i] = max(old[i-1], min(z, old[i])).
void insert_depth(Listing &out, EntryLayout layout, int k)
{
    static constexpr std::string_view components = "xyzw";
    static constexpr std::string_view shifted = "xxyz";
    const int per_entry = fragments_per_entry(layout);
    out.line("TEMP t;");
    reject(out, layout, k);
    for (int e = 0; e < entry_count(layout, k); ++e) {
        const auto used = static_cast<std::size_t>(std::min(per_entry, k - e * per_entry));
        out.line("MIN t.{}, fragment.position.z, kbuffer[{}];", components.substr(0, used), e);
        if (e == 0)
            out.line("MOV result.kbuffer[0].x, t;");
        else
            out.line("MAX result.kbuffer[{}].x, kbuffer[{}].{}, t;", e, e - 1,
                     components[std::size_t(per_entry - 1)]);
        if (used > 1)
            out.line("MAX result.kbuffer[{}].{}, kbuffer[{}].{}, t;", e,
                     components.substr(1, used - 1), e, shifted);
    }
}

} // namespace

Result<EntryLayout> parse_entry_layout(std::string_view name)
{
    for (const LayoutFacts &f : all_layouts) {
        if (f.name == name)
            return f.layout;
    }
    return Error{fmt::format("no such layout: {} (rgbz, packed, depth or depth4)", name)};
}

std::string_view name_of(EntryLayout layout)
{
    return facts(layout).name;
}

int fragments_per_entry(EntryLayout layout)
{
    return facts(layout).fragments_per_entry;
}

int entry_count(EntryLayout layout, int k)
{
    const int per_entry = fragments_per_entry(layout);
    return (k + per_entry - 1) / per_entry;
}

int max_fragments(EntryLayout layout)
{
    return max_kbuffer_entries * fragments_per_entry(layout);
}

Result<std::string> make_insertion_program(EntryLayout layout, int k)
{
    if (k < 1 || k > max_fragments(layout))
        return Error{fmt::format("k is {}, but the layout {} has programs for 1 to {}", k,
                                 name_of(layout), max_fragments(layout))};
    Listing out;
    out.line("!!ARBfp1.0");
    out.line("OPTION MESA_kbuffer_program;");
    out.line("# Keeps the {} nearest fragments, nearest first, equal depths as they arrive.", k);
    out.line("# Entries: {}. Clear depths to 1.", facts(layout).meaning);
    switch (layout) {
    case EntryLayout::rgbz:
        insert_rgbz(out, k);
        break;
    case EntryLayout::packed:
        insert_packed(out, k);
        break;
    case EntryLayout::depth:
    case EntryLayout::depth4:
        insert_depth(out, layout, k);
        break;
    }
    out.line("END");
    return out.text();
}

} // namespace kb
