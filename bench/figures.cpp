// Which promised figures there are, and on which scenes.
#include "bench/figures.h"

#include "bench/rows.h"

namespace lodestone::bench {

namespace {

// A section over one scene; without the scene it is left out and said so.
FigureSection sceneSection(const std::string& title,
                           const std::function<Result<ScenePtr>(Inputs&)>& find,
                           const std::function<Result<void>(Bench&, const ScenePtr&)>& add) {
    return {title, [=](Bench& bench) -> Result<void> {
                const Result<ScenePtr> scene = find(bench.inputs);
                if (!scene)
                    return tl::unexpected(scene.error());
                if (*scene)
                    return add(bench, *scene);
                bench.table.tell("not measured: no such input", "");
                return {};
            }};
}

using AddScene = std::function<Result<void>(Bench&, const ScenePtr&, SketchInput)>;

// Rows for a scene of ours and, if a folder is given, for the one of the same name in it.
struct SceneRows {
    const char* title;
    const char* name;
    SketchInput ours; // what our scene is; a given one is the sketch's
    AddScene add;
};

void addBoth(std::vector<FigureSection>& sections,
             const SceneRows& rows,
             const std::string& given) {
    sections.push_back(sceneSection(
        rows.title,
        [name = rows.name](Inputs& inputs) { return inputs.own(name); },
        [rows](Bench& bench, const ScenePtr& scene) { return rows.add(bench, scene, rows.ours); }));
    if (!given.empty())
        sections.push_back(sceneSection(
            std::string(rows.title) + " (given)",
            [name = rows.name](Inputs& inputs) { return inputs.given(name); },
            [rows](Bench& bench, const ScenePtr& scene) {
                return rows.add(bench, scene, SketchInput::Same);
            }));
}

AddScene alone(const AloneTargets& targets) {
    return [targets](Bench& bench, const ScenePtr& scene, SketchInput input) {
        return addAloneRows(bench, scene, targets, input);
    };
}

AddScene instanced(const InstancedTargets& targets) {
    return [targets](Bench& bench, const ScenePtr& scene, SketchInput input) {
        return addInstancedRows(bench, scene, targets, input);
    };
}

} // namespace

std::vector<FigureSection> figureSections(const std::string& given) {
    const auto equal = [](Bench& bench, const ScenePtr& scene, SketchInput) {
        return addEqualRows(bench, scene);
    };
    const auto cards = [](Bench& bench, const ScenePtr& scene, SketchInput) {
        return addCardRows(bench, scene);
    };
    constexpr SketchInput kSame = SketchInput::Same;
    constexpr SketchInput kAnother = SketchInput::Another;
    std::vector<FigureSection> sections{sceneSection(
        "Stanford bunny",
        [](Inputs& inputs) { return inputs.stanfordBunny(); },
        [](Bench& bench, const ScenePtr& scene) {
            return addAloneRows(bench, scene, bunnyTargets(), kSame);
        })};
    addBoth(sections, {"Our bunny", "bunny", kAnother, alone(bunnyTargets())}, "");
    for (const SceneRows& rows :
         {SceneRows{"Displaced sphere", "sphere", kSame, alone(sphereTargets())},
          SceneRows{"Maple", "maple", kAnother, instanced(mapleTargets())},
          SceneRows{"Village", "village", kAnother, instanced(villageTargets())},
          SceneRows{"Maple at equal triangles", "maple", kAnother, equal},
          SceneRows{"Village at equal triangles", "village", kAnother, equal},
          SceneRows{"Leaf cards", "cards", kSame, cards}})
        addBoth(sections, rows, given);
    sections.push_back({"Read-out", addReadOutRows});
    sections.push_back({"Files and schedules", addFileRows});
    sections.push_back({"Distance", addDistanceRows});
    sections.push_back({"Memory", addMemoryRows});
    return sections;
}

} // namespace lodestone::bench
