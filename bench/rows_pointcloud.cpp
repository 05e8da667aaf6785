#include "bench/rows_pointcloud.h"

#include "bench/frame_turns.h"
#include "bench/quality.h"
#include "bench/rows_live.h"
#include "bench/table.h"
#include "bench/timing.h"
#include "scene/expand.h"
#include "simplify/algorithm.h"

#include <algorithm>
#include <fmt/core.h>
#include <iostream>
#include <numeric>

namespace lodestone::bench {

namespace {

// Of the file that the paper measured, in whose units its thresholds are.
constexpr double kPaperDiagonal = 0.2503;

double percentOfPaperBunny(double threshold) {
    return 100.0 * threshold / kPaperDiagonal;
}

// A run of a method, as the paper's figures name it.
struct Setting {
    std::string label;
    ParameterValues values;
};

struct MethodSettings {
    std::string_view id;
    std::vector<Setting> settings;
};

Setting distanceSetting(std::string_view parameter, double threshold) {
    return {fmt::format("{:.4f}", threshold),
            {{std::string(parameter), percentOfPaperBunny(threshold)}}};
}

Setting angleSetting(double degrees) {
    return {fmt::format("{:.0f}°", degrees), {{"angle", degrees}, {"passes", 1.0}}};
}

Setting bothSetting(double threshold, double degrees) {
    return {fmt::format("{:.4f}, {:.0f}°", threshold, degrees),
            {{"radius", percentOfPaperBunny(threshold)}, {"angle", degrees}}};
}

std::vector<MethodSettings> paperSettings(PointCloudExtent extent) {
    std::vector<MethodSettings> methods{
        {"vt", {{"–", {{"coverage", 1.0}}}}},
        {"fad", {angleSetting(30), angleSetting(70), angleSetting(110), angleSetting(150)}},
        {"ivdd", {}},
        {"ss", {}},
        {"vtd", {}},
        {"fass",
         {bothSetting(0.0012, 30),
          bothSetting(0.0012, 150),
          bothSetting(0.0014, 30),
          bothSetting(0.0014, 150)}}};
    for (MethodSettings& method : methods) {
        if (method.settings.empty())
            for (const double threshold : {0.0011, 0.0012, 0.0013, 0.0014})
                method.settings.push_back(
                    distanceSetting(method.id == "ss" ? "radius" : "distance", threshold));
        if (extent == PointCloudExtent::Quick)
            method.settings.resize(1);
    }
    return methods;
}

// Of the mesh that a submesh's primitives make together, welded by position; each submesh once.
struct EdgeCounts {
    std::uint64_t open = 0;         // in one face
    std::uint64_t non_manifold = 0; // in more than two
};

EdgeCounts countEdges(const Lod& lod) {
    using Corner = std::array<float, 3>;
    EdgeCounts counts;
    for (const LodSubmesh& submesh : lod.submeshes) {
        std::vector<std::array<Corner, 2>> edges;
        for (const GeometryPtr& geometry : submesh.primitives)
            for (std::size_t i = 0; i + 2 < geometry->indices.size(); i += 3)
                for (std::size_t k = 0; k < 3; ++k) {
                    std::array<Corner, 2> edge;
                    for (std::size_t end = 0; end < 2; ++end) {
                        const glm::vec3& p =
                            geometry->positions[geometry->indices[i + (k + end) % 3]];
                        edge[end] = {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}; // -0 = 0
                    }
                    std::ranges::sort(edge);
                    edges.push_back(edge);
                }
        std::ranges::sort(edges);
        for (auto begin = edges.begin(); begin != edges.end();) {
            const auto end = std::upper_bound(begin, edges.end(), *begin);
            counts.open += end - begin == 1 ? 1 : 0;
            counts.non_manifold += end - begin > 2 ? 1 : 0;
            begin = end;
        }
    }
    return counts;
}

std::uint64_t uniqueVertices(const Lod& lod) {
    std::uint64_t vertices = 0;
    for (const LodSubmesh& submesh : lod.submeshes)
        for (const GeometryPtr& geometry : submesh.primitives)
            vertices += geometry->positions.size();
    return vertices;
}

std::string changeText(double ratio) {
    return fmt::format("{:+.1f} %", 100.0 * (ratio - 1.0));
}

std::string edgeText(const EdgeCounts& edges) {
    return fmt::format("{} / {}", countText(edges.open), countText(edges.non_manifold));
}

struct Simplified {
    ScenePtr scene; // whose submeshes the LOD replaces
    std::shared_ptr<const Lod> lod;
    double cpu_seconds = 0.0; // from the scene to the LOD
};

// target: null for the parameters' own.
Result<Simplified> simplify(const ScenePtr& scene,
                            const Algorithm& algorithm,
                            const ParameterValues& values,
                            const Target& target) {
    ScenePtr input = scene;
    if (algorithm.expands) {
        Result<ScenePtr> expanded = expandScene(*scene, {});
        if (!expanded)
            return tl::unexpected(expanded.error());
        input = *expanded;
    }
    const double start = cpuSeconds();
    const Result<LodSourcePtr> source = algorithm.prepare(input, values, {}, {});
    if (!source)
        return tl::unexpected(source.error());
    const ByteModel bytes((*source)->scene(), ExportOptions{});
    const std::uint64_t position = (*source)->resolve(target, bytes).position;
    auto lod = std::make_shared<const Lod>((*source)->readOut(position, nullptr));
    return Simplified{(*source)->scene(), std::move(lod), cpuSeconds() - start};
}

// --- the paper's protocol

struct ProtocolRow {
    std::string_view method;
    std::string label;
    Simplified result;
};

Result<std::vector<ProtocolRow>> simplifyAll(const ScenePtr& scene, PointCloudExtent extent) {
    std::vector<ProtocolRow> rows;
    for (const MethodSettings& method : paperSettings(extent)) {
        const Algorithm& algorithm = *findAlgorithm(method.id);
        for (const Setting& setting : method.settings) {
            Result<Simplified> result =
                simplify(scene, algorithm, setting.values, {Target::Kind::Ratio, 0.0});
            if (!result)
                return tl::unexpected(result.error());
            rows.push_back({algorithm.short_name, setting.label, std::move(*result)});
        }
    }
    return rows;
}

// [1 + rows]: of the scene itself, then of each row's LOD.
Result<std::vector<FrameTimes>>
timeFrames(const ScenePtr& scene, std::span<const ProtocolRow> rows, PointCloudExtent extent) {
    std::vector<FrameColumn> columns{{scene, std::make_shared<const Lod>(fullLod(*scene))}};
    for (const ProtocolRow& row : rows)
        columns.push_back({row.result.scene, row.result.lod});
    FrameTurns turns;
    turns.budget_s = 200.0; // for where the CPU draws and is busy, too
    if (extent == PointCloudExtent::Quick)
        turns.turns = 20;
    return timeFramesInTurns(columns, turns);
}

double meanOf(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Result<void> writeProtocol(std::ostream& out, const ScenePtr& scene, PointCloudExtent extent) {
    const Result<std::vector<ProtocolRow>> rows = simplifyAll(scene, extent);
    if (!rows)
        return tl::unexpected(rows.error());
    const Lod full = fullLod(*scene);
    const auto times = timeFrames(scene, *rows, extent);
    if (!times)
        return tl::unexpected(times.error());
    const FrameTimes& before = times->front();
    out << fmt::format(
        "Before: {} vertices, {} triangles, {:.3f} ms a frame, {:.3f} ms of CPU "
        "time, {} edges with one face / with more than two. {} frames of each were "
        "counted.\n\n"
        "| method | parameter | vertices | triangles | frame | change | CPU time | "
        "change | build | Hausdorff | mean | open / non-manifold edges |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        countText(uniqueVertices(full)),
        countText(full.triangles),
        meanOf(before.wall_ms),
        meanOf(before.cpu_ms),
        edgeText(countEdges(full)),
        countText(before.wall_ms.size() * std::uint64_t{FrameTurns{}.frames_a_turn}));
    for (std::size_t r = 0; r < rows->size(); ++r) {
        const ProtocolRow& row = (*rows)[r];
        const FrameTimes& frames = (*times)[r + 1];
        const Lod& lod = *row.result.lod;
        const Result<Distance> distance = distanceToFull({scene.get(), &lod});
        if (!distance)
            return tl::unexpected(distance.error());
        out << fmt::format("| {} | {} | {} | {} | {:.3f} ms | {} | {:.3f} ms | {} | {} | {} | {} | "
                           "{} |\n",
                           row.method,
                           row.label,
                           countText(uniqueVertices(lod)),
                           countText(lod.triangles),
                           meanOf(frames.wall_ms),
                           changeText(medianRatio(frames.wall_ms, before.wall_ms)),
                           meanOf(frames.cpu_ms),
                           changeText(medianRatio(frames.cpu_ms, before.cpu_ms)),
                           secondsText(row.result.cpu_seconds),
                           percentText(distance->hausdorff),
                           percentText(distance->mean),
                           edgeText(countEdges(lod)));
    }
    return {};
}

// --- at equal triangles

Result<void> writeEqual(std::ostream& out, const ScenePtr& scene) {
    constexpr double kRatio = 0.2;
    out << "| method | triangles | of the target | from scene to LOD | Hausdorff | mean | "
           "open / non-manifold edges |\n|---|---|---|---|---|---|---|\n";
    const double target = kRatio * static_cast<double>(countScene(*scene).triangles);
    for (const std::string_view id : {"quadric", "ias", "vt", "fad", "ivdd", "ss", "vtd", "fass"}) {
        const Algorithm& algorithm = *findAlgorithm(id);
        const Result<Simplified> result =
            simplify(scene, algorithm, {}, {Target::Kind::Triangles, target});
        if (!result)
            return tl::unexpected(result.error());
        const Lod& lod = *result->lod;
        const Result<Distance> distance = distanceToFull({result->scene.get(), &lod});
        if (!distance)
            return tl::unexpected(distance.error());
        out << fmt::format("| {} | {} | {:.1f} % | {} | {} | {} | {} |\n",
                           algorithm.short_name,
                           countText(lod.triangles),
                           100.0 * static_cast<double>(lod.triangles) / target,
                           secondsText(result->cpu_seconds),
                           percentText(distance->hausdorff),
                           percentText(distance->mean),
                           edgeText(countEdges(lod)));
    }
    return {};
}

struct Part {
    std::string title;
    std::function<Result<ScenePtr>(Inputs&)> find; // null: absent
    std::function<Result<void>(std::ostream&, const ScenePtr&)> write;
};

std::vector<Part> allParts(PointCloudExtent extent) {
    const auto stanford = [](Inputs& inputs) { return inputs.stanfordBunny(); };
    const auto own = [](const char* name) {
        return [name](Inputs& inputs) { return inputs.own(name); };
    };
    const auto protocol = [extent](std::ostream& out, const ScenePtr& scene) {
        return writeProtocol(out, scene, extent);
    };
    return {{"Six methods: the paper's protocol, Stanford bunny", stanford, protocol},
            {"Six methods: the paper's protocol, our bunny", own("bunny"), protocol},
            {"Six methods at 20 % of the triangles, Stanford bunny", stanford, writeEqual},
            {"Six methods at 20 % of the triangles, our bunny", own("bunny"), writeEqual},
            {"Six methods at 20 % of the triangles, chair", own("chair"), writeEqual},
            {"Six methods at 20 % of the triangles, maple", own("maple"), writeEqual},
            {"Six methods at 20 % of the triangles, village", own("village"), writeEqual},
            {"Six methods while a slider moves, Stanford bunny", stanford, writeLiveSliders},
            {"Six methods while a slider moves, our bunny", own("bunny"), writeLiveSliders},
            {"Six methods while a slider moves, maple", own("maple"), writeLiveSliders},
            {"Six methods while a slider moves, village", own("village"), writeLiveSliders}};
}

} // namespace

int writePointCloud(std::ostream& out,
                    Inputs& inputs,
                    PointCloudExtent extent,
                    const TitleFilter& wanted) {
    int code = 0;
    for (const Part& part : allParts(extent)) {
        if (!wanted(part.title))
            continue;
        std::cerr << part.title << '\n';
        out << "\n### " << part.title << "\n\n";
        const Result<ScenePtr> scene = part.find(inputs);
        Result<void> written;
        if (!scene)
            written = tl::unexpected(scene.error());
        else if (!*scene)
            out << "Not measured: no such input.\n";
        else
            written = part.write(out, *scene);
        if (!written) {
            std::cerr << "lodestone_bench: " << part.title << ": " << written.error().message
                      << '\n';
            code = exitCode(written.error().kind);
        }
    }
    return code;
}

} // namespace lodestone::bench
