// SPDX-License-Identifier: MIT

#include "bench/report.hpp"

#include "lib/io/output_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace kb::bench
{

nlohmann::json to_json(const nlohmann::json &machine, std::span<const Row> rows)
{
    nlohmann::json results = nlohmann::json::array();
    for (const Row &row : rows)
        results.push_back({{"scene", row.scene},
                           {"method", row.method},
                           {"variant", row.variant},
                           {"driver", row.driver},
                           {"k", row.k},
                           {"passes", row.passes},
                           {"triangles", row.triangles},
                           {"fragments", row.fragments},
                           {"ms_median", row.ms.median},
                           {"ms_p5", row.ms.p5},
                           {"ms_p95", row.ms.p95},
                           {"ratio_median", row.ratio.median},
                           {"ratio_p5", row.ratio.p5},
                           {"ratio_p95", row.ratio.p95},
                           {"bytes_per_pixel", row.bytes_per_pixel},
                           {"err_max", row.error.max},
                           {"err_rmse", row.error.rmse},
                           {"err_share", row.error.share},
                           {"err_all_max", row.error_all.max},
                           {"err_all_rmse", row.error_all.rmse},
                           {"err_all_share", row.error_all.share}});
    return {{"machine", machine}, {"results", results}};
}

/// How the ratios to z-buffering of this row and of framebuffer fetch with the same k compare, or
/// "-" without such a row.
static std::string ratio_to_fbfetch(std::span<const Row> rows, const Row &row)
{
    const auto found = std::ranges::find_if(rows, [&](const Row &other) {
        return other.scene == row.scene && other.method == "fbfetch" && other.k == row.k;
    });
    return found == rows.end() ? "-"
                               : fmt::format("{:.2f}", row.ratio.median / found->ratio.median);
}

std::string to_table(std::span<const Row> rows)
{
    std::string table = fmt::format(
        "{:<8} {:<16} {:<10} {:>3} {:>6} {:>9} {:>9} {:>9} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9}\n",
        "scene", "method", "variant", "k", "passes", "ms", "p5", "p95", "/zbuffer", "/fbfetch",
        "bytes/px", "err_max", "err_rmse", "err_share");
    for (const Row &row : rows)
        table += fmt::format(
            "{:<8} {:<16} {:<10} {:>3} {:>6} {:>9.2f} {:>9.2f} {:>9.2f} {:>8.2f} {:>8} "
            "{:>8} {:>8.5f} {:>9.6f} {:>9.6f}\n",
            row.scene, row.method, row.variant, row.k == 0 ? "-" : std::to_string(row.k),
            row.passes, row.ms.median, row.ms.p5, row.ms.p95, row.ratio.median,
            row.driver == "ours" ? ratio_to_fbfetch(rows, row) : "-", row.bytes_per_pixel,
            row.error.max, row.error.rmse, row.error.share);
    return table;
}

Status prepare_outputs(const std::filesystem::path &results, const std::filesystem::path &pictures)
{
    std::vector<OutputFile> files{{results, ".json"}};
    if (!pictures.empty())
        files.push_back({pictures / "picture.png", ".png"});
    for (const OutputFile &output : files) {
        std::error_code code;
        if (output.file.has_parent_path())
            std::filesystem::create_directories(output.file.parent_path(), code);
        if (code)
            return Error{fmt::format("cannot write {}: {}", output.file.string(), code.message())};
    }
    return kb::prepare_outputs(files);
}

Status write_json(const std::filesystem::path &path, const nlohmann::json &document)
{
    const std::string text = document.dump(2) + "\n";
    return write_file(path, std::as_bytes(std::span(text)));
}

} // namespace kb::bench
