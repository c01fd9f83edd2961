// SPDX-License-Identifier: MIT
//
// More fragments than layers.

#include "tests/hard_cases/cases.hpp"
#include "tests/hard_cases/model.hpp"

#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace kb::hard
{

namespace
{

/// 11. Alphas are multiples of 1/64, so that 1 - a is exact; n - 1 products below 1 round by half
/// of 2^-24 relative to 1 at most, and so does 1 - T: less than n * 2^-24.
Outcome k_overflow(const Gl &gl, Method &method, const Shape &shape)
{
    Outcome outcome;
    SceneInGl in_gl(gl, {});
    double wrong_layers = 0.0;
    double alpha_error = 0.0;
    for (const int k : {1, 2, 4, 8, 16}) {
        for (const int m : {0, 5}) {
            std::vector<int> order(static_cast<std::size_t>(k + m));
            std::iota(order.begin(), order.end(), 0);
            shuffle(order, static_cast<std::uint32_t>(k + m));
            Mesh mesh;
            const auto alpha_of = [](int rank) { return (1 + rank * 7 % 20) / 64.0; };
            const auto depth_of = [](int rank) { return (rank + 1) / 32.0; };
            for (const int rank : order)
                append_full(mesh, depth_of(rank), {rank / 8.0, alpha_of(rank), rank});
            in_gl.replace(mesh);
            Shape own = shape;
            own.k = k;
            const auto passes = method.draw_passes(own, k + m, [&] { in_gl.draw(); });
            const Layers &first = passes.front().layers;

            double transmittance = 1.0;
            for (int rank = 0; rank < k; ++rank)
                transmittance *= 1.0 - alpha_of(rank);
            wrong_layers += percentage(first, [&](const auto &f) {
                for (int rank = 0; rank < static_cast<int>(f.size()); ++rank) {
                    const Fragment exact{depth_of(rank), static_cast<float>(rank / 8.0),
                                         static_cast<float>(alpha_of(rank)),
                                         static_cast<float>(rank)};
                    if (f[static_cast<std::size_t>(rank)] != exact)
                        return true;
                }
                return static_cast<int>(f.size()) != k;
            });
            for (const auto &fragments : first) {
                const double alpha = static_cast<double>(composite_front_to_back(fragments).alpha);
                alpha_error = std::max(alpha_error, std::abs(alpha - (1.0 - transmittance)) /
                                                        (k * std::ldexp(1.0, -24)));
            }
            if (!method.continues())
                continue;
            // What is left: told by the flag, counted by going on.
            outcome.push_back({fmt::format("k = {}, m = {}: OVERFLOW", k, m), m > 0 ? 1.0 : 0.0,
                               passes.front().overflow ? 1.0 : 0.0});
            append_extremes(outcome, fmt::format("k = {}, m = {}: remainder", k, m), m,
                            extremes(join(passes), [k](const auto &f) {
                                return static_cast<int>(f.size()) - k;
                            }));
        }
    }
    Outcome all{{"samples whose layers are not bit for bit the nearest k, %", 0.0, wrong_layers},
                {"alpha of the layers kept: error in units of k * 2^-24", 0.0, alpha_error, 1.0}};
    all.insert(all.end(), outcome.begin(), outcome.end());
    return all;
}

} // namespace

std::vector<Case> overflow_cases()
{
    return {{11, "k overflow",
             "n = k + m shuffled layers: the nearest k bit for bit, alpha 1 - product(1 - a) of "
             "those kept to n * 2^-24, the reported remainder equals m (a k-buffer program reports "
             "none: what falls out is lost)",
             with_and_without_samples({{"", {}}}), k_overflow}};
}

} // namespace kb::hard
