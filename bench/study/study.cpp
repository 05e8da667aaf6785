#include "bench/study/study.h"

#include "bench/study/study_report.h"
#include "scene/generate.h"

#include <array>
#include <atomic>
#include <filesystem>
#include <fmt/core.h>
#include <fstream>
#include <iostream>
#include <tbb/parallel_for.h>

namespace lodestone::bench {

namespace {

Result<void> writeText(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    if (!file)
        return fail(ErrorKind::Failed, path.string() + ": cannot be written");
    return {};
}

// One after the other, so that times are of one thing alone.
Result<void> measureTable(Study& study, int rounds) {
    for (const char* name : {"bunny", "chair", "maple", "village"}) {
        std::cerr << "table: " << name << '\n';
        Result<TableRow> row = measureTableRow(name, rounds);
        if (!row)
            return tl::unexpected(row.error());
        study.table.push_back(std::move(*row));
    }
    const Result<ScenePtr> tree = generateScene("maple");
    if (!tree)
        return tl::unexpected(tree.error());
    Result<std::vector<SizeCurve>> curves = measureSizeCurves(*tree);
    if (!curves)
        return tl::unexpected(curves.error());
    study.tree_curves = std::move(*curves);
    for (const TableRow& row : study.table)
        if (row.name == "maple")
            study.tree_bytes = row.original_bytes;
    return {};
}

void measureSet(Study& study, const std::vector<StudyModel>& set) {
    study.rows.resize(set.size());
    std::atomic<std::size_t> done{0};
    tbb::parallel_for(std::size_t{0}, set.size(), [&](std::size_t i) {
        study.rows[i] = measureModel(set[i], study.options);
        const std::size_t count = ++done;
        if (count % 50 == 0 || count == set.size())
            std::cerr << fmt::format("models: {} of {}\n", count, set.size());
    });
}

} // namespace

int runStudy(const StudyRun& run) {
    const std::filesystem::path folder = run.folder;
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    Study study;
    Result<void> done = measureTable(study, run.rounds);
    if (done) {
        measureSet(study, studySet(run.models, run.made));
        for (const auto& [name, text] : {std::pair{"study.csv", studyCsv(study)},
                                         {"study.json", studyJson(study)},
                                         {"study.html", studyPage(study)}})
            if (done)
                done = writeText(folder / name, text);
    }
    if (!done) {
        std::cerr << "lodestone_bench: " << done.error().message << '\n';
        return 1;
    }
    std::cout << studyText(study);
    return 0;
}

} // namespace lodestone::bench
