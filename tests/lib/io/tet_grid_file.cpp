// SPDX-License-Identifier: MIT

#include "tests/lib/io/tet_grid_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

namespace kb::test
{

namespace
{

/// Text and blocks of numbers.
class VtkFile
{
public:
    explicit VtkFile(bool is_binary) : is_binary_(is_binary) {}

    void text(const std::string &line) { content_ += line + '\n'; }

    template <class T>
    void number(T value)
    {
        if (!is_binary_) {
            content_ += fmt::format("{} ", value);
            return;
        }
        auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
        if constexpr (std::endian::native == std::endian::little)
            std::ranges::reverse(bytes);
        content_.append(bytes.data(), bytes.size());
    }

    void end_block() { content_ += '\n'; }
    const std::string &content() const { return content_; }

private:
    bool is_binary_;
    std::string content_;
};

} // namespace

static void write_cells(VtkFile &file, const TetGrid &grid)
{
    file.text(fmt::format("CELLS {} {}", grid.cells.size(), 5 * grid.cells.size()));
    for (const glm::uvec4 &cell : grid.cells) {
        file.number<std::int32_t>(4);
        for (int i = 0; i < 4; ++i)
            file.number(static_cast<std::int32_t>(cell[i]));
    }
    file.end_block();
}

static void write_cells_5(VtkFile &file, const TetGrid &grid)
{
    file.text(fmt::format("CELLS {} {}\nOFFSETS vtktypeint64", grid.cells.size() + 1,
                          4 * grid.cells.size()));
    for (std::size_t i = 0; i <= grid.cells.size(); ++i)
        file.number(static_cast<std::int64_t>(4 * i));
    file.end_block();
    file.text("CONNECTIVITY vtktypeint64");
    for (const glm::uvec4 &cell : grid.cells)
        for (int i = 0; i < 4; ++i)
            file.number(static_cast<std::int64_t>(cell[i]));
    file.end_block();
}

std::string vtk_file(const TetGrid &grid, VtkForm form)
{
    const bool is_binary = form == VtkForm::binary || form == VtkForm::binary_5;
    const bool is_version_5 = form == VtkForm::ascii_5 || form == VtkForm::binary_5;
    VtkFile file(is_binary);
    file.text(fmt::format("# vtk DataFile Version {}\na test\n{}\nDATASET UNSTRUCTURED_GRID",
                          is_version_5 ? "5.1" : "3.0", is_binary ? "BINARY" : "ASCII"));
    file.text(fmt::format("POINTS {} float", grid.points.size()));
    for (const glm::vec3 &p : grid.points)
        for (int axis = 0; axis < 3; ++axis)
            file.number(p[axis]);
    file.end_block();
    is_version_5 ? write_cells_5(file, grid) : write_cells(file, grid);
    file.text(fmt::format("CELL_TYPES {}", grid.cells.size()));
    for (std::size_t i = 0; i < grid.cells.size(); ++i)
        file.number<std::int32_t>(10);
    file.end_block();
    file.text(fmt::format("POINT_DATA {}", grid.points.size()));
    for (const ScalarField &field : grid.fields) {
        file.text(fmt::format("SCALARS {} float\nLOOKUP_TABLE default", field.name));
        for (const float value : field.values)
            file.number(value);
        file.end_block();
    }
    return file.content();
}

TetGrid two_cells()
{
    TetGrid grid;
    grid.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
    grid.cells = {{0, 1, 2, 3}, {0, 2, 1, 4}};
    grid.fields = {{"temperature", {0.5F, 1.0F, 2.0F, 3.0F, -4.0F}},
                   {"pressure", {1.0F, 2.0F, 3.0F, 4.0F, 5.0F}}};
    return grid;
}

} // namespace kb::test
