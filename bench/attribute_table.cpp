#include "bench/attribute_table.h"

#include "app/image_source.h"
#include "app/main/headless_images.h"
#include "bench/peers/reduce_scene.h"
#include "bench/quality.h"
#include "bench/table.h"
#include "render/pixels.h"
#include "scene/import.h"

#include <algorithm>
#include <array>
#include <fmt/core.h>
#include <iostream>

namespace lodestone::bench {

namespace {

constexpr std::array kRatios{0.5, 0.2, 0.05};
constexpr std::uint64_t kFewest = 100;     // triangles: below there is nothing to simplify
constexpr std::uint64_t kMost = 1'000'000; // instanced ones that are drawn in software

constexpr std::size_t kViews = 8;

// All around, from above and from below in turn.
std::vector<OrbitView> views() {
    std::vector<OrbitView> views;
    for (std::size_t i = 0; i < kViews; ++i)
        views.push_back({22.5 + 45.0 * static_cast<double>(i), i % 2 == 0 ? 30.0 : -20.0});
    return views;
}

// Whether a picture is to be seen on it.
bool isTextured(const Scene& scene) {
    const auto shows = [&](const Primitive& primitive) {
        if (primitive.material == kNone || primitive.mode != PrimitiveMode::Triangles)
            return false;
        const Material& material = scene.materials[primitive.material];
        const auto there = [&](const TextureRef& texture) {
            return texture.image != kNone && scene.images[texture.image].bytes;
        };
        return there(material.base_color_texture) || there(material.normal_texture) ||
               there(material.emissive_texture);
    };
    const SceneCounts counts = countScene(scene);
    return counts.triangles >= kFewest && counts.triangles <= kMost &&
           std::ranges::any_of(scene.submeshes, [&](const Submesh& submesh) {
               return std::ranges::any_of(submesh.primitives, shows);
           });
}

// Those in bad/ are not meant to load.
std::vector<std::filesystem::path> modelsIn(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files = importableFiles(folder);
    std::erase_if(files, [&](const std::filesystem::path& file) {
        return *file.lexically_relative(folder).begin() == "bad";
    });
    return files;
}

// One model: the original, then pairs of a peer's and ours.
struct Case {
    ScenePtr scene;
    std::vector<ImageColumn> columns;
    std::vector<AttributeRow> rows; // rows[i]: columns[1 + 2 i] and columns[2 + 2 i]
};

Result<LodSourcePtr> prepareOurs(const ScenePtr& scene, const ParameterValues& parameters) {
    const SceneCounts counts = countScene(*scene);
    const Algorithm& algorithm =
        *findAlgorithm(counts.instances > counts.submeshes ? "ias" : "quadric");
    ParameterValues own;
    for (const auto& [id, value] : parameters)
        if (std::ranges::find(algorithm.parameters, id, &ParameterInfo::id) !=
            algorithm.parameters.end())
            own[id] = value;
    return algorithm.prepare(scene, own, {}, {});
}

Result<Case> makeCase(const AttributeBench& bench, const ScenePtr& scene) {
    const Result<LodSourcePtr> source = prepareOurs(scene, bench.parameters);
    if (!source)
        return tl::unexpected(source.error());
    Case made;
    made.scene = scene;
    made.columns.push_back({scene, std::make_shared<const Lod>(fullLod(*scene)), "original"});
    for (const double ratio : kRatios) {
        const PeerInput input(*scene, Welding::AsStored, ratio);
        for (std::size_t p = 0; p < bench.peers.size(); ++p) {
            Result<ReducedScene> reduced = input.reduce(bench.peers[p]);
            if (!reduced)
                return tl::unexpected(reduced.error());
            AttributeRow row;
            row.ratio = ratio;
            row.peer = p;
            row.their_triangles = reduced->lod.triangles;
            if (row.their_triangles == 0)
                continue;
            auto ours = std::make_shared<const Lod>(
                lodAtTriangles(**source, static_cast<double>(row.their_triangles)));
            row.our_triangles = ours->triangles;
            made.columns.push_back({scene,
                                    std::make_shared<const Lod>(std::move(reduced->lod)),
                                    fmt::format("peer {} {:g} %", p + 1, 100.0 * ratio)});
            made.columns.push_back(
                {(*source)->scene(), ours, fmt::format("ours {:g} %", 100.0 * ratio)});
            made.rows.push_back(row);
        }
    }
    return made;
}

// Draws all columns, sets the rows' differences; result: the pictures of all columns from one view
// after the other, for the contact sheet.
Result<std::vector<SheetCell>> drawCase(const AttributeBench& bench, Case& made) {
    PictureRequest request;
    request.columns = made.columns;
    request.views = views();
    request.width_px = request.height_px = bench.picture_px;
    std::vector<Picture> references;
    std::vector<std::vector<ImageDifference>> pairs(made.columns.size());
    std::vector<SheetCell> cells(kViews * made.columns.size());
    const auto take = [&](PictureOrigin origin, Picture picture) -> Result<void> {
        SheetCell& cell = cells[origin.view * made.columns.size() + origin.column];
        cell.picture.width = picture.width_px;
        cell.picture.height = picture.height_px;
        cell.picture.rgba = picture.rgba;
        cell.label = made.columns[origin.column].label;
        if (origin.column == 0) {
            references.push_back(std::move(picture));
            return {};
        }
        Result<ImageDifference> pair = comparePictures(references[origin.view], picture, {}, {});
        if (!pair)
            return tl::unexpected(pair.error());
        pairs[origin.column].push_back(*pair);
        return {};
    };
    const std::unique_ptr<ImageSource> images = makeHeadlessImages();
    if (Result<void> drawn = images->draw(request, take, {}); !drawn)
        return tl::unexpected(drawn.error());
    for (std::size_t i = 0; i < made.rows.size(); ++i) {
        made.rows[i].their_flip = combined(pairs[1 + 2 * i]).flip;
        made.rows[i].our_flip = combined(pairs[2 + 2 * i]).flip;
    }
    return cells;
}

Result<void> writeSheet(const std::filesystem::path& path, const std::vector<SheetCell>& cells) {
    SheetOptions options;
    options.columns = static_cast<std::uint32_t>(cells.size() / kViews);
    const Result<Pixels> sheet = composeSheet(cells, options);
    return sheet ? writePng(path, *sheet) : tl::unexpected(sheet.error());
}

bool noWorse(const AttributeRow& row) {
    constexpr double kDraw = 1e-4; // FLIP that no eye tells apart
    return row.our_flip <= row.their_flip + kDraw;
}

std::string markdownOf(const AttributeBench& bench, std::span<const AttributeRow> rows) {
    std::string text = "\n## Textured models as pictures\n\n"
                       "FLIP (mean over 8 views, lit) against the original, ours at no more "
                       "triangles than the peer kept; **bold**: the peer is better.\n\n";
    for (std::size_t p = 0; p < bench.peers.size(); ++p) {
        std::size_t cases = 0;
        std::size_t good = 0;
        for (const AttributeRow& row : rows)
            if (row.peer == p) {
                ++cases;
                good += noWorse(row) ? 1 : 0;
            }
        text += fmt::format(
            "- {}: ours no worse in {} of {} cases ({:.0f} %)\n",
            bench.peers[p].name,
            good,
            cases,
            cases > 0 ? 100.0 * static_cast<double>(good) / static_cast<double>(cases) : 0.0);
    }
    text += "\n| model | ratio | peer | their triangles | our triangles | their FLIP | our FLIP | "
            "ours / theirs |\n|---|---|---|---|---|---|---|---|\n";
    for (const AttributeRow& row : rows) {
        const std::string their = fmt::format("{:.4f}", row.their_flip);
        text += fmt::format("| {} | {:g} % | {} | {} | {} | {} | {:.4f} | {:.2f} |\n",
                            row.model,
                            100.0 * row.ratio,
                            row.peer + 1,
                            countText(row.their_triangles),
                            countText(row.our_triangles),
                            noWorse(row) ? their : "**" + their + "**",
                            row.our_flip,
                            row.their_flip > 0.0 ? row.our_flip / row.their_flip : 1.0);
    }
    return text;
}

Result<void> addModel(AttributeTable& table,
                      const AttributeBench& bench,
                      const std::string& name,
                      const ScenePtr& scene) {
    Result<Case> made = makeCase(bench, scene);
    if (!made)
        return tl::unexpected(made.error());
    const Result<std::vector<SheetCell>> cells = drawCase(bench, *made);
    if (!cells)
        return tl::unexpected(cells.error());
    for (AttributeRow& row : made->rows) {
        row.model = name;
        table.rows.push_back(row);
    }
    return bench.sheets.empty() ? Result<void>()
                                : writeSheet(bench.sheets / (name + ".png"), *cells);
}

} // namespace

int addAttributeTable(AttributeTable& table,
                      const AttributeBench& bench,
                      const std::filesystem::path& models,
                      const TitleFilter& wanted) {
    int code = 0;
    for (const std::filesystem::path& file : modelsIn(models)) {
        const std::string name = file.stem().string() + file.extension().string();
        if (!wanted(name))
            continue;
        const Result<ScenePtr> scene = importScene(file, {});
        if (!scene || !isTextured(**scene))
            continue;
        std::cerr << "attributes: " << name << '\n';
        if (const Result<void> added = addModel(table, bench, name, *scene); !added) {
            std::cerr << "lodestone_bench: attributes: " << name << ": " << added.error().message
                      << '\n';
            code = exitCode(added.error().kind);
        }
    }
    table.markdown = markdownOf(bench, table.rows);
    return code;
}

} // namespace lodestone::bench
