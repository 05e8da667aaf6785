#include "bench/micro/ratios.h"

#include "bench/table.h"

#include <cmath>
#include <fmt/core.h>
#include <fstream>
#include <nlohmann/json.hpp>

namespace lodestone::bench {

Result<Ratios> readBaseline(const std::filesystem::path& path) {
    std::ifstream file(path);
    const nlohmann::json document = nlohmann::json::parse(file, nullptr, false);
    if (!document.is_object())
        return badInput(path.string() + ": not a baseline: write one with --write-baseline");
    Ratios ratios;
    for (const auto& [name, value] : document.items()) {
        if (!value.is_number() || !(value.get<double>() > 0.0))
            return badInput(path.string() + ": '" + name +
                            "' is not a positive number: write it anew with --write-baseline");
        ratios[name] = value.get<double>();
    }
    return ratios;
}

Result<void> writeBaseline(const std::filesystem::path& path, std::span<const HotPath> paths) {
    nlohmann::json document = nlohmann::json::object();
    for (const HotPath& hot : paths)
        document[hot.name] = std::round(1e4 * hot.ratio) / 1e4;
    std::ofstream file(path);
    file << document.dump(4) << '\n';
    if (!file.flush())
        return fail(ErrorKind::Failed, path.string() + ": cannot be written");
    return {};
}

std::vector<std::string> slowerThan(const Ratios& baseline, std::span<const HotPath> paths) {
    std::vector<std::string> slower;
    for (const HotPath& hot : paths) {
        const auto before = baseline.find(hot.name);
        if (before != baseline.end() && !(hot.ratio <= kSlowerBy * before->second))
            slower.push_back(fmt::format(
                "{}: {:.3g} of the reference, {:.3g} before", hot.name, hot.ratio, before->second));
    }
    return slower;
}

std::string ratioTable(std::span<const HotPath> paths, const Ratios& baseline) {
    std::string text = "| hot path | CPU time | over the reference | before | change |\n"
                       "|---|---|---|---|---|\n";
    for (const HotPath& hot : paths) {
        const auto before = baseline.find(hot.name);
        const bool known = before != baseline.end();
        text += fmt::format("| {} | {} | {:.4g} | {} | {} |\n",
                            hot.name,
                            secondsText(hot.seconds),
                            hot.ratio,
                            known ? fmt::format("{:.4g}", before->second) : "–",
                            known ? fmt::format("{:.2f}×", hot.ratio / before->second) : "–");
    }
    return text;
}

} // namespace lodestone::bench
