// SPDX-License-Identifier: MIT

#include "tests/hard_cases/outcome.hpp"

#include <algorithm>
#include <cmath>

namespace kb::hard
{

bool Quantity::right() const
{
    return std::abs(measured - expected) <= tolerance;
}

bool Row::right() const
{
    return !outcome.empty() && std::ranges::all_of(outcome, &Quantity::right);
}

nlohmann::json to_json(const std::vector<Row> &rows)
{
    nlohmann::json list = nlohmann::json::array();
    for (const Row &row : rows) {
        nlohmann::json quantities = nlohmann::json::array();
        for (const Quantity &quantity : row.outcome)
            quantities.push_back({{"what", quantity.what},
                                  {"expected", quantity.expected},
                                  {"measured", quantity.measured},
                                  {"tolerance", quantity.tolerance},
                                  {"right", quantity.right()}});
        list.push_back({{"row", row.number},
                        {"name", row.name},
                        {"promise", row.promise},
                        {"form", row.form},
                        {"method", row.method},
                        {"quantities", quantities},
                        {"why_not", row.why_not},
                        {"right", row.right()}});
    }
    return list;
}

} // namespace kb::hard
