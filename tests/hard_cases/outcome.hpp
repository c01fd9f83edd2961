// SPDX-License-Identifier: MIT
//
// What a case measured, as numbers beside the analytic ones, and the rows of the table.

#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace kb::hard
{

/// A number of a case. It is right if it is not further from the expected one than the tolerance.
struct Quantity {
    std::string what;
    double expected;
    double measured;
    double tolerance = 0.0;

    /// NaN is right nowhere.
    bool right() const;
};

using Outcome = std::vector<Quantity>;

/// A case in one of its forms, drawn by one method.
struct Row {
    int number;          ///< That of the list of hard cases, or 0.
    std::string name;    ///< "exact duplicates"
    std::string promise; ///< What is expected, in words.
    std::string form;    ///< "4 samples", or empty.
    std::string method;  ///< "depth-peeling"
    Outcome outcome;     ///< Empty if the method cannot do it.
    std::string why_not; ///< Then this says why.

    bool right() const;
};

nlohmann::json to_json(const std::vector<Row> &rows);

} // namespace kb::hard
