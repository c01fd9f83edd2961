// SPDX-License-Identifier: MIT

#include "bench/study.hpp"

#include "bench/exact.hpp"
#include "bench/gl_scene.hpp"
#include "bench/machine.hpp"
#include "bench/methods.hpp"
#include "bench/study_scene.hpp"
#include "bench/temporary_folder.hpp"
#include "bench/worker_process.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <utility>

namespace kb::bench
{

using nlohmann::json;

namespace
{

template <class... Arguments>
void progress(fmt::format_string<Arguments...> text, Arguments &&...arguments)
{
    fmt::print(stderr, text, std::forward<Arguments>(arguments)...);
    std::fflush(stderr);
}

/// A run on the scene at hand.
struct Active {
    Run run;
    WorkerProcess *worker;
    int id; ///< The worker's number for it.
    Row row;
    std::vector<double> times;
    std::vector<double> ratios; ///< To the z-buffered frame right before each.
};

class Runner
{
public:
    explicit Runner(const Options &options) : options_(options)
    {
        start_worker("stock", ""); // It makes the exact images, too.
        for (const std::string &scene : options.scenes)
            for (const Run &run : runs_of(scene))
                if (!workers_.contains({run.driver, run.environment}))
                    start_worker(run.driver, run.environment);
    }

    Study run()
    {
        study_.machine = describe_machine();
        for (const auto &[driver, name] : driver_names_)
            study_.machine["driver_" + driver] = name;
        study_.machine["commit"] = options_.commit;
        study_.machine["width"] = options_.size.width;
        study_.machine["height"] = options_.size.height;
        study_.machine["rounds"] = options_.rounds;
        study_.machine["scenes"] = json::object();
        for (const std::string &scene : options_.scenes)
            measure(scene);
        return std::move(study_);
    }

private:
    std::vector<int> ks_of(const std::string &scene) const
    {
        if (!options_.ks.empty())
            return options_.ks;
        const std::span<const int> ks = default_ks(scene);
        return {ks.begin(), ks.end()};
    }

    std::vector<Run> runs_of(const std::string &scene) const
    {
        return plan_runs(options_.methods, ks_of(scene));
    }

    void start_worker(const std::string &driver, const std::string &setting)
    {
        const std::filesystem::path &prefix = driver == "ours" ? options_.ours : options_.stock;
        const auto [place, added] = workers_.emplace(
            std::pair(driver, setting), std::make_unique<WorkerProcess>(driver, prefix, setting));
        const json hello = place->second->ask({{"do", "hello"}});
        // The figures are worth nothing if both are the same driver.
        if (hello.at("kbuffer_program").get<bool>() != (driver == "ours"))
            throw std::runtime_error(
                fmt::format("the Mesa in {} {} GL_MESA_kbuffer_program", prefix.string(),
                            driver == "ours" ? "lacks" : "is to be stock, but has"));
        driver_names_[driver] = hello.at("driver").get<std::string>();
        progress("{}: {}{}{}\n", driver, driver_names_[driver], setting.empty() ? "" : ", ",
                 setting);
    }

    void measure(const std::string &scene)
    {
        json about;
        for (auto &[key, worker] : workers_)
            about = worker->ask({{"do", "scene"},
                                 {"name", scene},
                                 {"dragon", options_.dragon.string()},
                                 {"width", options_.size.width},
                                 {"height", options_.size.height}});
        const auto triangles = about.at("triangles").get<std::uint64_t>();

        progress("{}: {} triangles, capturing fragments for exact images\n", scene, triangles);
        const json capture = capture_exact_images(ks_of(scene));
        about.update(capture);
        study_.machine["scenes"][scene] = about;
        progress("{}: {} fragments, depth complexity {}, {} pixels covered\n", scene,
                 capture.at("fragments").get<std::uint64_t>(),
                 capture.at("depth_complexity").get<int>(),
                 capture.at("covered_pixels").get<std::uint64_t>());

        std::vector<Active> active;
        for (const Run &run : runs_of(scene)) {
            WorkerProcess &worker = *workers_.at({run.driver, run.environment});
            const json made = worker.ask(
                {{"do", "method"}, {"method", run.method}, {"variant", run.variant}, {"k", run.k}});
            Row row;
            row.scene = scene;
            row.method = run.method;
            row.variant = run.variant;
            row.driver = run.driver;
            row.k = run.k;
            row.passes = made.at("passes").get<int>();
            row.triangles = triangles;
            row.fragments = capture.at("fragments").get<std::uint64_t>();
            active.push_back({run, &worker, made.at("id").get<int>(), std::move(row), {}, {}});
            // Compiles its shaders too, before frames are measured.
            look_at_picture(active.back());
        }
        for (int round = 1; round <= options_.rounds; ++round) {
            show_round(scene, round);
            for (Active &one : active)
                draw_frame(one, active.front());
        }
        for (Active &one : active) {
            one.row.ms = spread_of(one.times);
            one.row.ratio = spread_of(one.ratios);
            study_.rows.push_back(std::move(one.row));
        }
    }

    /// A z-buffered frame, then one of the method: what slows the machine down slows both.
    static void draw_frame(Active &one, Active &zbuffer)
    {
        const auto milliseconds = [](const Active &run) {
            return run.worker->ask({{"do", "frame"}, {"id", run.id}}).at("ms").get<double>();
        };
        const double base = milliseconds(zbuffer);
        zbuffer.times.push_back(base);
        if (&one != &zbuffer)
            one.times.push_back(milliseconds(one));
        one.ratios.push_back(one.times.back() / base);
    }

    /// One line that moves on a terminal; in a log, a line every quarter of the way.
    void show_round(const std::string &scene, int round) const
    {
        const int last = options_.rounds;
        if (isatty(STDERR_FILENO) != 0)
            progress("\r{}: round {} of {}{}", scene, round, last, round == last ? "\n" : "");
        else if (round == last || (round - 1) * 4 / last != round * 4 / last)
            progress("{}: round {} of {}\n", scene, round, last);
    }

    std::filesystem::path exact_path(int k) const
    {
        return folder_.path() / fmt::format("exact-{}.pfm", k);
    }

    json capture_exact_images(std::vector<int> ks)
    {
        ks.insert(ks.end(), {0, all_fragments}); // 0: for z-buffering
        std::vector<std::string> paths;
        for (const int k : ks)
            paths.push_back(exact_path(k).string());
        return workers_.at({"stock", ""})->ask({{"do", "capture"}, {"ks", ks}, {"paths", paths}});
    }

    void look_at_picture(Active &one) const
    {
        const std::filesystem::path path = folder_.path() / "image.pfm";
        const json drawn =
            one.worker->ask({{"do", "image"}, {"id", one.id}, {"path", path.string()}});
        // Known only now: it may depend on the scene.
        one.row.bytes_per_pixel = drawn.at("bytes_per_pixel").get<int>();
        const ImageRgbaF image = must(read_pfm(path));
        if (!options_.pictures.empty()) {
            must(write_png(options_.pictures /
                               fmt::format("{}-{}.png", one.row.scene, label(one.run)),
                           to_rgba8(image)));
        }
        // Eight-bit colors are off by 1/255 at most; as floats, by a rounding more.
        constexpr double tolerance = 1.0 / 255.0 + 1e-6;
        one.row.error = must(compare(image, must(read_pfm(exact_path(one.run.k))), tolerance));
        one.row.error_all =
            must(compare(image, must(read_pfm(exact_path(all_fragments))), tolerance));
    }

    const Options &options_;
    TemporaryFolder folder_;
    /// By driver and setting.
    std::map<std::pair<std::string, std::string>, std::unique_ptr<WorkerProcess>> workers_;
    std::map<std::string, std::string> driver_names_;
    Study study_;
};

} // namespace

Study run_study(const Options &options)
{
    return Runner(options).run();
}

} // namespace kb::bench
