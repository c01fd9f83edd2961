// SPDX-License-Identifier: MIT

#include "tests/hard_cases/cases.hpp"

#include <algorithm>

namespace kb::hard
{

std::vector<Case> all_cases()
{
    std::vector<Case> cases;
    for (auto list : {coplanar_cases(), depth_cases(), coverage_cases(), value_cases(),
                      overflow_cases(), mixture_cases(), volume_cases()})
        std::ranges::move(list, std::back_inserter(cases));
    std::ranges::stable_sort(cases, {}, &Case::number);
    std::ranges::move(invariance_cases(), std::back_inserter(cases));
    return cases;
}

std::vector<Form> with_and_without_samples(const std::vector<Form> &forms)
{
    std::vector<Form> all;
    for (const int samples : {0, 4}) {
        for (Form form : forms) {
            form.shape.samples = samples;
            if (samples > 0)
                form.name += form.name.empty() ? "4 samples" : ", 4 samples";
            all.push_back(std::move(form));
        }
    }
    return all;
}

void append_extremes(Outcome &outcome, const std::string &what, double expected,
                     const Extremes &measured, double tolerance)
{
    outcome.push_back({what + ", least", expected, measured.least, tolerance});
    outcome.push_back({what + ", greatest", expected, measured.greatest, tolerance});
}

double coverage(const std::vector<Fragment> &fragments)
{
    double transmittance = 1.0;
    for (const Fragment &fragment : fragments)
        transmittance *= 1.0 - static_cast<double>(fragment.alpha);
    return 1.0 - transmittance;
}

bool ids_count_from(const std::vector<Fragment> &fragments, int first)
{
    return std::ranges::all_of(fragments, [id = first](const Fragment &fragment) mutable {
        return fragment.id == static_cast<float>(id++);
    });
}

} // namespace kb::hard
