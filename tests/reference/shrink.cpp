// SPDX-License-Identifier: MIT

#include "tests/reference/shrink.hpp"

#include <algorithm>

namespace kb::reference
{

namespace
{

class Shrinker
{
public:
    Shrinker(const Scene &scene, const Fails &fails, int most_trials)
        : best_(scene), fails_(fails), trials_left_(most_trials)
    {
    }

    Scene run()
    {
        // What one pass makes simpler may let the other go on.
        bool smaller = true;
        while (smaller && trials_left_ > 0) {
            smaller = remove_steps();
            smaller |= remove_triangles();
            smaller |= simplify_options();
            smaller |= simplify_steps();
        }
        return best_;
    }

private:
    /// Takes the scene if it is a scene and fails.
    bool take(const Scene &scene)
    {
        if (trials_left_ <= 0 || !check_scene(scene))
            return false;
        --trials_left_;
        if (!fails_(scene))
            return false;
        best_ = scene;
        return true;
    }

    /// Removes ranges of `count()` items, halves first and single ones at last.
    template <class Count, class Without>
    bool remove_ranges(Count count, Without without)
    {
        bool removed = false;
        for (std::size_t size = std::max<std::size_t>(count() / 2, 1);;) {
            for (std::size_t from = 0; from < count();) {
                const std::size_t to = std::min(from + size, count());
                if (take(without(from, to)))
                    removed = true;
                else
                    from = to;
            }
            if (size == 1)
                return removed;
            size /= 2;
        }
    }

    bool remove_steps()
    {
        return remove_ranges([this] { return best_.steps.size(); },
                             [this](std::size_t from, std::size_t to) {
                                 Scene scene = best_;
                                 scene.steps.erase(
                                     scene.steps.begin() + static_cast<std::ptrdiff_t>(from),
                                     scene.steps.begin() + static_cast<std::ptrdiff_t>(to));
                                 return scene;
                             });
    }

    bool remove_triangles()
    {
        return remove_ranges([this] { return best_.triangle_count(); },
                             [this](std::size_t from, std::size_t to) {
                                 Scene scene = best_;
                                 std::size_t index = 0;
                                 for (Step &step : scene.steps)
                                     std::erase_if(step.triangles, [&](const Triangle &) {
                                         const std::size_t i = index++;
                                         return i >= from && i < to;
                                     });
                                 return scene;
                             });
    }

    template <class Change>
    bool try_change(Change change)
    {
        Scene scene = best_;
        change(scene);
        return to_json(scene) != to_json(best_) && take(scene);
    }

    bool simplify_options()
    {
        bool simpler = false;
        for (const int k : {1, 2, 3, 4})
            simpler |= best_.k > k && try_change([k](Scene &s) { s.k = k; });
        simpler |= try_change([](Scene &s) { s.samples = 0; });
        simpler |= try_change([](Scene &s) { s.all_passes = false; });
        simpler |= try_change([](Scene &s) { s.color_mask = {true, true, true, true}; });
        simpler |= try_change([](Scene &s) { s.viewport = {0, 0, s.width, s.height}; });
        simpler |= try_change([](Scene &s) { s.depth_range = {0.0, 1.0}; });
        simpler |= try_change([](Scene &s) { s.zero_to_one = false; });
        simpler |= try_change([](Scene &s) { s.flat = true; });
        simpler |= try_change([](Scene &s) { s.clear_depth = s.farthest_first() ? 0.0F : 1.0F; });
        if (best_.extension == Extension::program)
            return simpler;
        simpler |= try_change([](Scene &s) {
            s.func = Func::less;
            s.clear_depth = 1.0F;
        });
        simpler |= try_change([](Scene &s) { s.depth_format = DepthFormat::d32f; });
        for (std::size_t a = best_.color_formats.size(); a-- > 0;)
            simpler |= try_change([a](Scene &s) {
                s.color_formats.erase(s.color_formats.begin() + static_cast<std::ptrdiff_t>(a));
            });
        return simpler;
    }

    bool simplify_steps()
    {
        bool simpler = false;
        for (std::size_t i = 0; i < best_.steps.size(); ++i) {
            simpler |= try_change([i](Scene &s) { s.steps[i].scissor.reset(); });
            simpler |= try_change([i](Scene &s) { s.steps[i].depth_mask = true; });
            simpler |= try_change([i](Scene &s) { s.steps[i].cull = Cull::none; });
        }
        return simpler;
    }

    Scene best_;
    const Fails &fails_;
    int trials_left_;
};

} // namespace

Scene shrink(const Scene &scene, const Fails &fails, int most_trials)
{
    return Shrinker(scene, fails, most_trials).run();
}

} // namespace kb::reference
