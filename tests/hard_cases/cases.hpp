// SPDX-License-Identifier: MIT
//
// The hard cases that the extensions can express. Each draws its scene by a method and gives
// numbers with their analytic values; how tolerances come about is said where they are given.

#pragma once

#include "tests/hard_cases/method.hpp"
#include "tests/hard_cases/outcome.hpp"

#include <functional>
#include <string>
#include <vector>

namespace kb::hard
{

struct Form {
    std::string name; ///< Empty if there is one only.
    Shape shape;
};

struct Case {
    int number; ///< That of the list of hard cases; 0 of an invariance, which has none.
    std::string name;
    std::string promise;
    std::vector<Form> forms;
    std::function<Outcome(const Gl &, Method &, const Shape &)> measure;
    std::string program_cannot{}; ///< Why a k-buffer program cannot express it, or empty.
    /// Whether the promise is one about order, which two layers in each other's place would break.
    bool about_order = true;
};

std::vector<Case> coplanar_cases(); ///< 1 to 4
std::vector<Case> depth_cases();    ///< 5 to 8
std::vector<Case> coverage_cases(); ///< 9, 24
std::vector<Case> value_cases();    ///< 10, 12, 13
std::vector<Case> overflow_cases(); ///< 11
std::vector<Case> mixture_cases();  ///< 25
std::vector<Case> volume_cases();   ///< 14 to 16, 22, 23
std::vector<Case> invariance_cases();

/// In the order of their numbers, invariances last.
std::vector<Case> all_cases();

/// Each form, then each with 4 samples, which is all that llvmpipe has.
std::vector<Form> with_and_without_samples(const std::vector<Form> &forms);

/// The part of the samples that meet a condition.
template <class Condition>
double percentage(const Layers &layers, Condition condition)
{
    std::size_t count = 0;
    for (const auto &fragments : layers)
        count += condition(fragments) ? 1 : 0;
    return 100.0 * static_cast<double>(count) / static_cast<double>(layers.size());
}

/// The least and the greatest of a number that each sample has.
struct Extremes {
    double least;
    double greatest;
};
template <class Number>
Extremes extremes(const Layers &layers, Number number)
{
    Extremes found{1e300, -1e300};
    for (const auto &fragments : layers) {
        const auto value = static_cast<double>(number(fragments));
        found = {std::min(found.least, value), std::max(found.greatest, value)};
    }
    return found;
}

/// Of a number that is to be the same in all samples: the least and the greatest, both exact.
void append_extremes(Outcome &outcome, const std::string &what, double expected,
                     const Extremes &measured, double tolerance = 0.0);

/// 1 - product(1 - alpha)
double coverage(const std::vector<Fragment> &fragments);

/// Whether the ids are those from `first` on, one by one.
bool ids_count_from(const std::vector<Fragment> &fragments, int first);

} // namespace kb::hard
