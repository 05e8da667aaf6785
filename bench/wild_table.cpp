#include "bench/wild_table.h"

#include "bench/quality.h"
#include "bench/table.h"
#include "simplify/algorithm.h"
#include "simplify/bake/atlas.h"
#include "simplify/measure/color_distance.h"
#include "simplify/measure/colored_side.h"

#include <array>
#include <cmath>
#include <fmt/core.h>
#include <functional>
#include <iostream>

namespace lodestone::bench {

namespace {

constexpr std::array kRatios{0.1, 0.01, 0.001};

// Real models of many parts; the first ones are those with pictures on them, too.
constexpr std::array kManyParts{"textured/office/office.obj",
                                "textured/oaktree/oaktree.gltf",
                                "textured/anisotropy-barn-lamp/AnisotropyBarnLamp.gltf",
                                "textured/PalmTree/PalmTree.gltf",
                                "textured/DamagedHelmet/DamagedHelmet.glb",
                                "textured/collapsed_fire_station/collapsed_fire_station.dae",
                                "textured/greySnapper/greySnapper_vertColor.glb",
                                "meshes/spider-stl-ascii/Spider_ascii.stl",
                                "meshes/wuson-stl/Wuson.stl",
                                "meshes/p47d-3ds/p47d.3ds",
                                "meshes/jeep-3ds/jeep1.3ds",
                                "meshes/monkeys_on_landscape/"
                                "monkeys_on_landscape_binary_with_normals_etc.ply",
                                "instanced/cafe/cafe.dae",
                                "instanced/VirtualCity/VC.gltf"};

constexpr std::array kPictures{"textured/DamagedHelmet/DamagedHelmet.glb",
                               "textured/Duck/Duck.glb",
                               "textured/oaktree/oaktree.gltf",
                               "textured/greySnapper/greySnapper_vertColor.glb",
                               "textured/PalmTree/PalmTree.gltf",
                               "textured/collapsed_fire_station/collapsed_fire_station.dae",
                               "instanced/cafe/cafe.dae",
                               "instanced/VirtualCity/VC.gltf"};

struct Method {
    const char* name;
    const char* algorithm;
    ParameterValues parameters;
};

// The first is what the others are compared with, the second the weaker of the paper's baselines.
std::vector<Method> methods() {
    const ParameterValues shape{{"uv-weight", 0.0}, {"normal-weight", 0.0}, {"color-weight", 0.0}};
    ParameterValues without_border = shape;
    without_border["boundary"] = 0.0;
    return {{"Quadric", "quadric", shape},
            {"Quadric, no border term", "quadric", without_border},
            {"Wild", "wild", {{"scope", 2.0}}},
            {"Wild, ε 0.1 %", "wild", {{"scope", 2.0}, {"epsilon", 0.1}}},
            {"Wild, ε 0.5 %", "wild", {{"scope", 2.0}, {"epsilon", 0.5}}},
            {"Wild, ε 0.1 %, near vertices",
             "wild",
             {{"scope", 2.0}, {"epsilon", 0.1}, {"virtual-edges", 1.0}}},
            {"Wild, no area term", "wild", {{"scope", 2.0}, {"area", 0.0}}}};
}

Result<LodSourcePtr> prepared(const ScenePtr& scene, const Method& method) {
    return findAlgorithm(method.algorithm)->prepare(scene, method.parameters, {}, {});
}

// Of one method on one model at one ratio, in % of the diagonal.
using Cell = std::array<double, 3>; // Hausdorff, mean, rms

struct Sums { // of logarithms of ratios to the two baselines
    std::array<Cell, 2> logs{};
    int count = 0;
};

Result<Cell> measured(const Scene& original, const LodSource& source, double ratio) {
    const Lod lod = lodAtTriangles(source, ratio * static_cast<double>(source.trianglesAt(0)));
    const Lod full = fullLod(original);
    const Result<Distance> d =
        measureDistance({&original, &full}, {source.scene().get(), &lod}, {100'000, 1}, {});
    if (!d)
        return tl::unexpected(d.error());
    return Cell{d->hausdorff, d->mean, d->rms};
}

using Grid = std::vector<std::array<Sums, kRatios.size()>>; // [methods][ratios]

Result<std::string> measureModel(const ScenePtr& scene, const char* name, Grid& grid) {
    const std::vector<Method> all = methods();
    std::array<std::array<Cell, kRatios.size()>, 2> base{};
    std::string rows;
    for (std::size_t m = 0; m < all.size(); ++m) {
        const Result<LodSourcePtr> source = prepared(scene, all[m]);
        if (!source)
            return tl::unexpected(source.error());
        rows += fmt::format("| {} | {} |", m == 0 ? name : "", all[m].name);
        for (std::size_t r = 0; r < kRatios.size(); ++r) {
            const Result<Cell> cell = measured(*scene, **source, kRatios[r]);
            if (!cell)
                return tl::unexpected(cell.error());
            rows += fmt::format(" {:.3g} / {:.3g} |", (*cell)[0], (*cell)[1]);
            if (m < 2)
                base[m][r] = *cell;
            if (m == 0)
                continue;
            Sums& sums = grid[m][r];
            ++sums.count;
            for (std::size_t b = 0; b < 2; ++b)
                for (std::size_t k = 0; k < 3; ++k)
                    sums.logs[b][k] +=
                        std::log(std::max((*cell)[k], 1e-6) / std::max(base[b][r][k], 1e-6));
        }
        rows += "\n";
    }
    return rows;
}

std::string meansText(const Grid& grid) {
    std::string text =
        "\n| method | against | maximum | mean | mean square |\n|---|---|---|---|---|\n";
    const std::vector<Method> all = methods();
    for (std::size_t m = 1; m < all.size(); ++m)
        for (std::size_t b = 0; b < (m == 1 ? 1u : 2u); ++b) {
            std::array<std::string, 3> columns;
            for (const Sums& sums : grid[m])
                for (std::size_t k = 0; k < 3; ++k) {
                    const double mean = sums.logs[b][k] / std::max(sums.count, 1);
                    columns[k] += fmt::format("{}{:.2f}",
                                              columns[k].empty() ? "" : " / ",
                                              std::exp(k == 2 ? 2.0 * mean : mean));
                }
            text += fmt::format("| {} | {} | {} | {} | {} |\n",
                                all[m].name,
                                all[b].name,
                                columns[0],
                                columns[1],
                                columns[2]);
        }
    return text;
}

// What could not be measured keeps its place in the table, and the rest is written all the same.
std::string absentRow(const std::string& name, const Error& error) {
    std::cerr << "lodestone_bench: " << error.message << '\n';
    return fmt::format("| {} | {} |\n", name, error.message);
}

int addDistances(WildTable& table, Inputs& inputs, const TitleFilter& wanted) {
    Grid grid(methods().size());
    std::string rows;
    int code = 0;
    for (const char* name : kManyParts) {
        const Result<ScenePtr> scene = inputs.model(name);
        if (!wanted(name) || (scene && !*scene))
            continue;
        std::cerr << "wild: " << name << '\n';
        const Result<std::string> text =
            scene ? measureModel(*scene, name, grid) : tl::unexpected(scene.error());
        if (!text) {
            rows += absentRow(name, text.error());
            code = exitCode(text.error().kind);
            continue;
        }
        rows += *text;
    }
    table.markdown +=
        "\n## Wild: models of many parts\n\nMaximum / mean distance in % of the "
        "diagonal at 10, 1 and 0.1 % of the triangles, all instances expanded, "
        "100,000 samples a side; at 0.1 % floors hold models of many materials back "
        "alike. Then geometric means over the models of the ratio to two "
        "baselines.\n\n| model | method | 10 % | 1 % | 0.1 % |\n|---|---|---|---|---|\n" +
        rows + meansText(grid);
    return code;
}

// Colour of a LOD with its textures kept or, with options, transferred.
Result<double> colorOf(const Scene& original,
                       const LodSource& source,
                       const std::optional<BakeOptions>& bake,
                       double ratio) {
    Lod lod = lodAtTriangles(source, ratio * static_cast<double>(source.trianglesAt(0)));
    ScenePtr scene = source.scene();
    if (bake) {
        Result<BakedScene> baked = source.transferred(lod, *bake, {});
        if (!baked)
            return tl::unexpected(baked.error());
        scene = std::move(baked->scene);
        lod = fullLod(*scene);
    }
    const Lod full = fullLod(original);
    const Result<ColorDistance> distance =
        measureColorDistance({&original, &full}, {scene.get(), &lod}, {100'000, 1}, {});
    if (!distance)
        return tl::unexpected(distance.error());
    return distance->mean;
}

// An atlas a material, or a larger one for all where there are many.
BakeOptions atlasesFor(const Scene& scene) {
    constexpr std::size_t kManyMaterials = 16;
    BakeOptions options;
    if (scene.materials.size() > kManyMaterials) {
        options.atlas_px = 4096;
        options.merge_materials = true;
    }
    return options;
}

// What a perfect transfer would leave: every point of the LOD has the colour of the original's
// point closest to it, so only what the shape has lost is left.
Result<double> colorBound(const Scene& original, const LodSource& source, double ratio) {
    const DistanceOptions options{100'000, 1};
    const Lod lod = lodAtTriangles(source, ratio * static_cast<double>(source.trianglesAt(0)));
    const Lod full = fullLod(original);
    const Result<MeasuredPair> pair =
        measuredPair({&original, &full}, {source.scene().get(), &lod}, options, {});
    if (!pair)
        return tl::unexpected(pair.error());
    const SurfaceColors colors(original);
    const ColoredSide of_original{pair->a, colors};
    const auto add =
        [&](ColorSums& sums, const SurfaceSample& sample, const ClosestSurface::Hit& hit) {
            const Triangle on = pair->b.surface.triangle(hit);
            const glm::dvec3 weights = closestWeights(sample.point, on);
            const glm::dvec3 point = on[0] * weights.x + on[1] * weights.y + on[2] * weights.z;
            const ClosestSurface::Hit back = ClosestSurface::Cursor(pair->a.surface).closest(point);
            sums.add(of_original.colorAt(sample.piece, sample.triangle, sample.weights) -
                     of_original.colorAt(back, point));
        };
    const Result<ColorSums> sums = sumOverSamples<ColorSums>(pair->a, pair->b, options, {}, add);
    if (!sums)
        return tl::unexpected(sums.error());
    return 0.5 * sums->mean(); // the way back costs nothing
}

Result<std::string> colorRow(const ScenePtr& scene, const std::string& name) {
    const Method kept{"", "quadric", {}};
    // Grown leaves lie elsewhere on purpose: colours of closest points would not tell anything.
    const Method moved{"", "wild", {{"scope", 2.0}, {"crowds", 0.0}}};
    const Result<LodSourcePtr> keeps = prepared(scene, kept);
    const Result<LodSourcePtr> transfers = prepared(scene, moved);
    if (!keeps || !transfers)
        return tl::unexpected(keeps ? transfers.error() : keeps.error());
    std::string row = fmt::format("| {} |", name);
    for (const double ratio : kRatios) {
        const Result<double> before = colorOf(*scene, **keeps, std::nullopt, ratio);
        BakeOptions options = atlasesFor(*scene);
        const Result<double> after = colorOf(*scene, **transfers, options, ratio);
        options.keep_better = true; // of no use where many materials share an atlas
        const Result<double> better =
            options.merge_materials ? after : colorOf(*scene, **transfers, options, ratio);
        const Result<double> least = colorBound(*scene, **transfers, ratio);
        for (const Result<double>* part : {&before, &after, &better, &least})
            if (!*part)
                return tl::unexpected(part->error());
        row += fmt::format(" {:.4f} : {:.4f} : {:.4f} : {:.4f} ({:.2f}, {:.2f}) |",
                           *least,
                           *better,
                           *after,
                           *before,
                           *after / *before,
                           *better / *before);
    }
    return row + "\n";
}

using NamedScenes = std::vector<std::pair<std::string, Result<ScenePtr>>>;
using RowOf = std::function<Result<std::string>(const ScenePtr& scene, const std::string& name)>;

// A row a scene. What fails is told and left out. Returns the exit code.
int addRows(WildTable& table, const NamedScenes& scenes, const RowOf& row_of) {
    int code = 0;
    for (const auto& [name, scene] : scenes) {
        if (scene && !*scene)
            continue;
        std::cerr << "wild: " << name << '\n';
        const Result<std::string> row =
            scene ? row_of(*scene, name) : tl::unexpected(scene.error());
        if (row) {
            table.markdown += *row;
            continue;
        }
        table.markdown += absentRow(name, row.error());
        code = exitCode(row.error().kind);
    }
    return code;
}

int addColors(WildTable& table, Inputs& inputs, const TitleFilter& wanted) {
    table.markdown +=
        "\n## Wild: texture transfer\n\nSymmetric colour Chamfer distance (0..√3), "
        "perfect : transferred with `keep-better` : transferred : kept by attribute-aware Quadric "
        "(transferred over kept without and with `keep-better`); atlases of 1024 pixels, or one of "
        "4096 for more than 16 "
        "materials; "
        "crowds do not grow. Perfect: each point of Wild's LOD has the colour of the closest point "
        "of the original.\n\n| model | 10 % | 1 % | 0.1 % |\n|---|---|---|---|\n";
    NamedScenes scenes;
    for (const char* name : kPictures)
        if (wanted(name))
            scenes.emplace_back(name, inputs.model(name));
    return addRows(table, scenes, colorRow);
}

// CPU seconds of the whole sequence by Quadric, by Wild and by Wild with virtual edges.
Result<std::string> timeRow(const ScenePtr& scene, const std::string& name) {
    std::vector<Contender> contenders;
    for (const std::size_t m : {std::size_t{0}, std::size_t{2}, std::size_t{3}})
        contenders.push_back({[scene, m]() -> Result<std::shared_ptr<const void>> {
            Result<LodSourcePtr> source = prepared(scene, methods()[m]);
            if (!source)
                return tl::unexpected(source.error());
            return std::shared_ptr<const void>(*source);
        }});
    const auto seconds = timeInTurns(contenders, 3);
    if (!seconds)
        return tl::unexpected(seconds.error());
    return fmt::format("| {} | {} | {} | {} | {:.2f} | {} | {:.2f} |\n",
                       name,
                       countText(countScene(*scene).triangles),
                       secondsText(spreadOf((*seconds)[0])),
                       secondsText(spreadOf((*seconds)[1])),
                       medianRatio((*seconds)[1], (*seconds)[0]),
                       secondsText(spreadOf((*seconds)[2])),
                       medianRatio((*seconds)[2], (*seconds)[0]));
}

// Growing spheres show how time grows, real models what parts and borders cost.
int addTimes(WildTable& table, Inputs& inputs) {
    table.markdown +=
        "\n## Wild: time\n\nCPU of the whole sequence on one thread (attributes do "
        "not count).\n\n| model | triangles | Quadric | Wild | ratio | ε 0.1 % | ratio "
        "|\n|---|---|---|---|---|---|---|\n";
    NamedScenes scenes;
    for (const std::uint32_t side : {46u, 91u, 182u})
        scenes.emplace_back("bumpy sphere", displacedSphere(side));
    for (const char* name : {"textured/office/office.obj",
                             "meshes/monkeys_on_landscape/"
                             "monkeys_on_landscape_binary_with_normals_etc.ply",
                             "meshes/horse/horse.ply"})
        scenes.emplace_back(name, inputs.model(name));
    return addRows(table, scenes, timeRow);
}

// With colours at its vertices, so that there is something to transfer.
Result<ScenePtr> coloredSphere(std::uint32_t side) {
    Result<ScenePtr> plain = displacedSphere(side);
    if (!plain)
        return plain;
    auto colored = std::make_shared<Scene>(**plain);
    for (Primitive& primitive : colored->submeshes[0].primitives) {
        auto geometry = std::make_shared<Geometry>(*primitive.geometry);
        Attribute color;
        color.semantic = "COLOR_0";
        color.components = 3;
        color.bytes.resize(geometry->positions.size() * color.stride());
        for (std::size_t v = 0; v < geometry->positions.size(); ++v)
            for (std::size_t c = 0; c < 3; ++c)
                setAttributeValue(
                    color, v, c, std::abs(geometry->positions[v][static_cast<int>(c)]));
        geometry->attributes.push_back(std::move(color));
        primitive.geometry = std::move(geometry);
    }
    return ScenePtr(std::move(colored));
}

// Texels that were traced, those on the borders of triangles included.
std::uint64_t samplesIn(const Scene& baked, std::uint32_t atlas_px) {
    std::uint64_t samples = 0;
    for (const Submesh& submesh : baked.submeshes)
        for (const Primitive& primitive : submesh.primitives) {
            const Geometry& geometry = *primitive.geometry;
            const Attribute* const uv = findAttribute(geometry.attributes, "TEXCOORD_0");
            for (std::size_t i = 0; uv && i + 2 < geometry.indices.size(); i += 3) {
                Bounds bounds; // of a right triangle along the axes
                for (std::size_t k = i; k < i + 3; ++k)
                    bounds.add({attributeValue(*uv, geometry.indices[k], 0),
                                attributeValue(*uv, geometry.indices[k], 1),
                                0.0});
                const glm::dvec3 size = (bounds.max - bounds.min) * static_cast<double>(atlas_px);
                AtlasPlace place;
                place.width = static_cast<std::uint32_t>(std::lround(size.x));
                place.height = static_cast<std::uint32_t>(std::lround(size.y));
                forEachTexel(place, [&](auto...) { ++samples; });
            }
        }
    return samples;
}

// CPU seconds of the whole sequence, and of a transfer to a level of 1,000 triangles.
Result<std::string> transferRow(const ScenePtr& scene, const std::string& name) {
    const Method method{"", "wild", {}};
    BakeOptions options;
    options.atlas_px = 270; // a little more than 56,000 samples
    const Result<LodSourcePtr> source = prepared(scene, method);
    if (!source)
        return tl::unexpected(source.error());
    const Lod lod = lodAtTriangles(**source, 1'000.0);
    const Result<BakedScene> baked = (*source)->transferred(lod, options, {});
    if (!baked)
        return tl::unexpected(baked.error());
    const std::array<Contender, 2> contenders{
        Contender{[&]() -> Result<std::shared_ptr<const void>> {
            Result<LodSourcePtr> made = prepared(scene, method);
            if (!made)
                return tl::unexpected(made.error());
            return std::shared_ptr<const void>(*made);
        }},
        Contender{[&]() -> Result<std::shared_ptr<const void>> {
            Result<BakedScene> made = (*source)->transferred(lod, options, {});
            if (!made)
                return tl::unexpected(made.error());
            return std::shared_ptr<const void>(made->scene);
        }}};
    const auto seconds = timeInTurns(contenders, 3);
    if (!seconds)
        return tl::unexpected(seconds.error());
    return fmt::format("| {} | {} | {} | {} | {} | {:.2f} |\n",
                       name,
                       countText(countScene(*scene).triangles),
                       secondsText(spreadOf((*seconds)[0])),
                       countText(samplesIn(*baked->scene, options.atlas_px)),
                       secondsText(spreadOf((*seconds)[1])),
                       medianRatio((*seconds)[1], (*seconds)[0]));
}

int addTransferTimes(WildTable& table) {
    table.markdown +=
        "\n## Wild: time of a transfer\n\nCPU of the whole sequence and of a transfer "
        "to a level of 1,000 triangles, one atlas of 270 pixels encoded as PNG "
        "included, on one thread; bound: no more than the sequence at 100,000 "
        "triangles.\n\n| model | triangles | sequence | samples | transfer | ratio "
        "|\n|---|---|---|---|---|---|\n";
    NamedScenes scenes;
    for (const std::uint32_t side : {46u, 91u, 182u})
        scenes.emplace_back("bumpy sphere with colours", coloredSphere(side));
    return addRows(table, scenes, transferRow);
}

} // namespace

int addWildTable(WildTable& table, Inputs& inputs, const TitleFilter& wanted) {
    table.markdown +=
        "\nWritten by `lodestone_bench --wild --out bench/WILD.md` (about seven minutes "
        "on a quiet machine). Distances and colours are the same every time.\n";
    const int distances = addDistances(table, inputs, wanted);
    const int colors = addColors(table, inputs, wanted);
    const int times = addTimes(table, inputs);
    const int transfers = addTransferTimes(table);
    return std::max({distances, colors, times, transfers});
}

} // namespace lodestone::bench
