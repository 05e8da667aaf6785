// lodestone_microbench: the hot paths in times of a reference kernel of the same run.
#include "bench/micro/hot_paths.h"
#include "bench/micro/ratios.h"
#include "bench/program_main.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <benchmark/benchmark.h>
#include <fmt/core.h>
#include <iostream>
#include <tbb/global_control.h>

namespace lodestone::bench {

namespace {

struct Options {
    std::string baseline;
    std::string write_baseline;
    std::string filter = ".";
    double seconds = 0.1; // of one repetition
    int repetitions = 5;
};

// Keeps what is measured instead of printing it.
class Collector final : public benchmark::BenchmarkReporter {
public:
    bool ReportContext(const Context& /*context*/) override { return true; } // NOLINT: its name

    void ReportRuns(const std::vector<Run>& runs) override { // NOLINT: its name
        for (const Run& run : runs) {
            if (run.run_type != Run::RT_Iteration)
                continue;
            const std::string name = run.run_name.function_name;
            if (run.error_occurred) {
                failed_.push_back(name);
                continue;
            }
            if (!seconds_.contains(name))
                names_.push_back(name);
            seconds_[name].push_back(run.GetAdjustedCPUTime() /
                                     benchmark::GetTimeUnitMultiplier(run.time_unit));
        }
    }

    const std::vector<std::string>& failed() const { return failed_; }

    // Errors: Failed if the reference was not among the runs.
    Result<std::vector<HotPath>> hotPaths() const {
        const auto reference = seconds_.find(kReferenceKernel);
        if (reference == seconds_.end())
            return fail(ErrorKind::Failed, "the reference kernel did not run");
        const double unit = spreadOf(reference->second).median;
        std::vector<HotPath> paths;
        paths.reserve(names_.size());
        for (const std::string& name : names_) {
            const Spread seconds = spreadOf(seconds_.at(name));
            paths.push_back({name, seconds, seconds.median / unit});
        }
        std::ranges::sort(paths, {}, &HotPath::name);
        return paths;
    }

private:
    std::vector<std::string> names_;
    std::vector<std::string> failed_;
    std::map<std::string, std::vector<double>> seconds_; // [repetitions]
};

Result<std::vector<HotPath>> measure(const Options& options) {
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    std::vector<std::string> words{"lodestone_microbench",
                                   fmt::format("--benchmark_min_time={}", options.seconds),
                                   fmt::format("--benchmark_repetitions={}", options.repetitions),
                                   "--benchmark_enable_random_interleaving=true"};
    std::vector<char*> arguments;
    arguments.reserve(words.size());
    for (std::string& word : words)
        arguments.push_back(word.data());
    auto count = static_cast<int>(arguments.size());
    benchmark::Initialize(&count, arguments.data());
    const Result<std::string> absent = registerHotPaths();
    if (!absent)
        return tl::unexpected(absent.error());
    if (!absent->empty())
        std::cerr << "lodestone_microbench: " << *absent << '\n';
    Collector collector;
    benchmark::RunSpecifiedBenchmarks(&collector, "^reference|" + options.filter);
    if (!collector.failed().empty())
        return fail(ErrorKind::Failed, collector.failed().front() + ": failed");
    return collector.hotPaths();
}

Result<std::vector<std::string>> report(const Options& options) {
    Ratios baseline;
    if (!options.baseline.empty()) {
        Result<Ratios> read = readBaseline(options.baseline);
        if (!read)
            return tl::unexpected(read.error());
        baseline = std::move(*read);
    }
    const Result<std::vector<HotPath>> paths = measure(options);
    if (!paths)
        return tl::unexpected(paths.error());
    std::cout << ratioTable(*paths, baseline);
    if (!options.write_baseline.empty())
        if (const Result<void> written = writeBaseline(options.write_baseline, *paths); !written)
            return tl::unexpected(written.error());
    return slowerThan(baseline, *paths);
}

int parseAndRun(int argc, char** argv) {
    Options options;
    CLI::App app("Times the hot paths against a reference kernel; Markdown on stdout. Exit code 1 "
                 "if one is more than 25 % slower than in the baseline.");
    app.add_option("--baseline", options.baseline, "ratios of a run before, to compare with")
        ->check(CLI::ExistingFile);
    app.add_option("--write-baseline", options.write_baseline, "write the ratios to this file");
    app.add_option("--filter", options.filter, "only names that match this regular expression");
    app.add_option("--seconds", options.seconds, "of one repetition")->capture_default_str();
    app.add_option("--repetitions", options.repetitions, "of each; medians are compared")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    const Result<std::vector<std::string>> slower = report(options);
    if (!slower) {
        std::cerr << "lodestone_microbench: " << slower.error().message << '\n';
        return exitCode(slower.error().kind);
    }
    for (const std::string& line : *slower)
        std::cout << "- slower by more than 25 %: " << line << '\n';
    return slower->empty() ? 0 : 1;
}

} // namespace

} // namespace lodestone::bench

int main(int argc, char** argv) {
    using namespace lodestone::bench;
    return programMain("lodestone_microbench", parseAndRun, argc, argv);
}
