#include "scene/expand.h"

#include "scene/expansion.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <span>
#include <tbb/parallel_for.h>
#include <tuple>

namespace lodestone {

namespace {

// More would not fit into memory in any sensible way.
constexpr std::uint64_t kMostVertices = std::uint64_t{1} << 28;

bool canMerge(const Submesh& submesh) {
    return std::ranges::all_of(submesh.primitives, [](const Primitive& primitive) {
        return primitive.mode == PrimitiveMode::Triangles &&
               primitive.geometry->morph_targets.empty();
    });
}

// Primitives merge if they agree in this.
using GroupKey = std::pair<std::uint32_t, std::string>;

GroupKey groupKey(const Primitive& primitive) {
    std::string attributes;
    for (const Attribute& attribute : primitive.geometry->attributes)
        attributes += attribute.semantic + ":" + std::to_string(static_cast<int>(attribute.type)) +
                      ":" + std::to_string(attribute.components) +
                      (attribute.normalized ? "n;" : ";");
    return {primitive.material, attributes};
}

// The same attributes without vertices.
GeometryPtr emptyLike(const Geometry& geometry) {
    Geometry empty;
    for (const Attribute& attribute : geometry.attributes) {
        empty.attributes.push_back(
            {attribute.semantic, attribute.type, attribute.components, attribute.normalized, {}});
    }
    return std::make_shared<const Geometry>(std::move(empty));
}

// Whether nothing but its place tells an instance from others.
bool canMerge(const Scene& scene, const Instance& instance) {
    const Node& node = scene.nodes[instance.node];
    return !node.animated && node.skin == kNone;
}

// mergeable: [scene.submeshes]
void planInstanceRoles(Expansion& expansion,
                       const Scene& scene,
                       const std::vector<bool>& mergeable) {
    expansion.merges.assign(scene.instances.size(), false);
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        expansion.merges[i] = mergeable[instance.submesh] && canMerge(scene, instance);
    }
}

// Whether what merges leaves the scene.
enum class Originals : std::uint8_t { Go, Stay };

std::string groupName(const Scene& scene, const ExpandGroup& group) {
    const std::uint32_t first = group.parts.front().submesh;
    if (group.parts.size() == 1 && scene.submeshes[first].primitives.size() == 1)
        return scene.submeshes[first].name;
    return group.material == kNone ? "no material" : scene.materials[group.material].name;
}

// Submeshes that keep an instance, or never had one, stay apart in any case.
void planSubmeshes(Expansion& expansion, const Scene& scene, Originals originals) {
    const std::vector<InstanceRange> ranges = instanceRanges(scene);
    Scene& skeleton = *expansion.skeleton;
    std::map<GroupKey, std::size_t> group_of;
    std::vector<Submesh> merged;
    for (std::uint32_t s = 0; s < scene.submeshes.size(); ++s) {
        bool any_merges = false;
        bool all_merge = ranges[s].size() > 0;
        for (std::uint32_t i = ranges[s].begin; i < ranges[s].end; ++i) {
            any_merges |= expansion.merges[i];
            all_merge &= expansion.merges[i];
        }
        if (!all_merge || originals == Originals::Stay) {
            expansion.apart.push_back(s);
            skeleton.submeshes.push_back(scene.submeshes[s]);
        }
        for (std::uint32_t p = 0; any_merges && p < scene.submeshes[s].primitives.size(); ++p) {
            const Primitive& primitive = scene.submeshes[s].primitives[p];
            const auto [found, is_new] =
                group_of.try_emplace(groupKey(primitive), expansion.groups.size());
            if (is_new) {
                expansion.groups.push_back({primitive.material, {}});
                Submesh submesh;
                submesh.primitives.push_back({});
                submesh.primitives[0].geometry = emptyLike(*primitive.geometry);
                submesh.primitives[0].material = primitive.material;
                merged.push_back(std::move(submesh));
            }
            expansion.groups[found->second].parts.push_back({s, p});
        }
    }
    for (std::size_t g = 0; g < merged.size(); ++g)
        merged[g].name = groupName(scene, expansion.groups[g]);
    expansion.first_merged = static_cast<std::uint32_t>(skeleton.submeshes.size());
    std::ranges::move(merged, std::back_inserter(skeleton.submeshes));
}

// Calls visit(instance) for the first `count` instances of a submesh's order.
template <class Visit>
void forEachKeptInstance(const InstanceRange& range,
                         const std::shared_ptr<const std::vector<std::uint32_t>>& order,
                         std::uint32_t count,
                         const Visit& visit) {
    for (std::uint32_t k = 0; k < count; ++k)
        visit(order ? (*order)[k] : range.begin + k);
}

// Kept instances of every submesh, split by what becomes of them; in the scene's order.
struct Kept {
    std::vector<std::vector<std::uint32_t>> merged; // [original submeshes]
    std::vector<std::vector<std::uint32_t>> apart;
};

template <class Submeshes>
Kept splitKept(const Expansion& expansion, const Scene& scene, const Submeshes& submeshes) {
    Kept kept;
    kept.merged.resize(submeshes.size());
    kept.apart.resize(submeshes.size());
    const std::vector<InstanceRange> ranges = instanceRanges(scene);
    for (std::size_t s = 0; s < submeshes.size(); ++s) {
        forEachKeptInstance(ranges[s],
                            submeshes[s].instance_order,
                            submeshes[s].kept_instances,
                            [&](std::uint32_t i) {
                                auto& list = expansion.merges[i] ? kept.merged[s] : kept.apart[s];
                                list.push_back(i);
                            });
        std::ranges::sort(kept.merged[s]);
    }
    return kept;
}

// Original instances as the skeleton numbers them.
std::shared_ptr<const std::vector<std::uint32_t>> renumbered(const Expansion& expansion,
                                                             std::vector<std::uint32_t> instances) {
    for (std::uint32_t& instance : instances)
        instance = expansion.new_index[instance];
    return std::make_shared<const std::vector<std::uint32_t>>(std::move(instances));
}

struct Task {
    std::uint32_t group = 0;
    ExpandPlace place;
    const Geometry* from = nullptr;
    std::uint32_t instance = 0;
};

struct Work {
    std::vector<std::shared_ptr<Geometry>> geometries; // [groups] sized, to be filled
    std::vector<Task> tasks;
};

// Places the pieces of one group after each other, each instance in a weld block of its own.
class GroupPlanner {
public:
    GroupPlanner(const Scene& scene, const Lod& lod, std::uint32_t group)
        : scene_(scene), lod_(lod), group_(group) {}

    // parts: of one submesh.
    Result<void> add(std::span<const ExpandPart> parts,
                     std::span<const std::uint32_t> instances,
                     std::vector<Task>& tasks) {
        for (const std::uint32_t instance : instances) {
            blocks_.push_back(static_cast<std::uint32_t>(vertices_));
            for (const ExpandPart& part : parts) {
                const Geometry& from = *lod_.submeshes[part.submesh].primitives[part.primitive];
                tasks.push_back(
                    {group_,
                     {static_cast<std::uint32_t>(vertices_), static_cast<std::uint32_t>(indices_)},
                     &from,
                     instance});
                vertices_ += from.positions.size();
                indices_ += from.indices.size();
                if (vertices_ > kMostVertices || indices_ > 8 * kMostVertices - 1)
                    return fail(ErrorKind::Failed,
                                scene_.name + ": expanding its instances gives more than " +
                                    std::to_string(kMostVertices) +
                                    " vertices; simplify it first or keep the instances");
            }
        }
        return {};
    }

    std::shared_ptr<Geometry> makeGeometry(const Geometry& skeleton) {
        auto geometry = std::make_shared<Geometry>(skeleton);
        geometry->positions.resize(vertices_);
        geometry->indices.resize(indices_);
        for (Attribute& attribute : geometry->attributes)
            attribute.bytes.resize(vertices_ * attribute.stride());
        // An instance whose pieces are empty has no block.
        blocks_.erase(std::unique(blocks_.begin(), blocks_.end()), blocks_.end());
        if (!blocks_.empty() && blocks_.back() == vertices_)
            blocks_.pop_back();
        geometry->weld_blocks = std::move(blocks_);
        return geometry;
    }

private:
    const Scene& scene_;
    const Lod& lod_;
    std::uint32_t group_ = 0;
    std::uint64_t vertices_ = 0;
    std::uint64_t indices_ = 0;
    std::vector<std::uint32_t> blocks_;
};

Result<Work>
planWork(const Expansion& expansion, const Scene& scene, const Lod& lod, const Kept& kept) {
    Work work;
    for (std::uint32_t g = 0; g < expansion.groups.size(); ++g) {
        GroupPlanner planner(scene, lod, g);
        std::span<const ExpandPart> left = expansion.groups[g].parts;
        while (!left.empty()) {
            const std::uint32_t submesh = left.front().submesh;
            std::size_t count = 1;
            while (count < left.size() && left[count].submesh == submesh)
                ++count;
            if (auto added = planner.add(left.first(count), kept.merged[submesh], work.tasks);
                !added)
                return tl::unexpected(added.error());
            left = left.subspan(count);
        }
        const Submesh& submesh = expansion.skeleton->submeshes[expansion.first_merged + g];
        work.geometries.push_back(planner.makeGeometry(*submesh.primitives[0].geometry));
    }
    return work;
}

bool runWork(Work& work, const Scene& scene, const JobContext& job) {
    std::atomic<std::size_t> done{0};
    tbb::parallel_for(std::size_t{0}, work.tasks.size(), [&](std::size_t t) {
        if (job.stopRequested())
            return;
        const Task& task = work.tasks[t];
        appendTransformed(*work.geometries[task.group],
                          task.place,
                          *task.from,
                          scene.instances[task.instance].transform);
        const std::size_t finished = ++done;
        if (finished % 256 == 0)
            job.report(static_cast<double>(finished) / static_cast<double>(work.tasks.size()));
    });
    return !job.stopRequested();
}

// A skeleton with what no expansion touches.
Expansion beginExpansion(const Scene& scene) {
    Expansion expansion;
    expansion.skeleton = std::make_shared<Scene>();
    Scene& skeleton = *expansion.skeleton;
    skeleton.name = scene.name;
    skeleton.materials = scene.materials;
    skeleton.images = scene.images;
    skeleton.cameras = scene.cameras;
    skeleton.file_bytes = scene.file_bytes;
    skeleton.notes = scene.notes;
    return expansion;
}

} // namespace

void countLod(Lod& lod) {
    lod.triangles = 0;
    lod.unique_triangles = 0;
    lod.instances = 0;
    for (const LodSubmesh& submesh : lod.submeshes) {
        std::uint64_t triangles = 0;
        for (const GeometryPtr& geometry : submesh.primitives)
            triangles += geometry->triangleCount();
        lod.unique_triangles += triangles;
        lod.triangles += triangles * submesh.kept_instances;
        lod.instances += submesh.kept_instances;
    }
}

std::vector<bool> mergingSubmeshes(const Scene& scene) {
    std::vector<bool> merging;
    for (const Submesh& submesh : scene.submeshes)
        merging.push_back(canMerge(submesh));
    for (const Instance& instance : scene.instances)
        if (!canMerge(scene, instance))
            merging[instance.submesh] = false;
    return merging;
}

Expansion planExpansion(const Scene& scene) {
    Expansion expansion = beginExpansion(scene);
    std::vector<bool> mergeable;
    for (const Submesh& submesh : scene.submeshes)
        mergeable.push_back(canMerge(submesh));
    planInstanceRoles(expansion, scene, mergeable);
    planSubmeshes(expansion, scene, Originals::Go);
    expandDocument(expansion, scene);
    return expansion;
}

Expansion planBesides(const Scene& scene) {
    Expansion expansion = beginExpansion(scene);
    planInstanceRoles(expansion, scene, mergingSubmeshes(scene));
    planSubmeshes(expansion, scene, Originals::Stay);
    extendDocument(expansion, scene);
    return expansion;
}

LodShape expandShape(const Expansion& expansion, const Scene& scene, const LodShape& shape) {
    const Kept kept = splitKept(expansion, scene, shape.submeshes);
    LodShape to;
    for (const std::uint32_t s : expansion.apart) {
        LodShape::SubmeshShape submesh = shape.submeshes[s];
        submesh.kept_instances = static_cast<std::uint32_t>(kept.apart[s].size());
        submesh.instance_order = renumbered(expansion, kept.apart[s]);
        to.submeshes.push_back(std::move(submesh));
    }
    for (const ExpandGroup& group : expansion.groups) {
        PrimitiveShape counts;
        for (const ExpandPart& part : group.parts) {
            const auto times = static_cast<std::uint32_t>(kept.merged[part.submesh].size());
            const PrimitiveShape& from = shape.submeshes[part.submesh].primitives[part.primitive];
            counts.vertices += from.vertices * times;
            counts.indices += from.indices * times;
        }
        to.submeshes.push_back({{counts}, 1, true, nullptr});
    }
    return to;
}

Result<Lod>
expandLod(const Expansion& expansion, const Scene& scene, const Lod& lod, const JobContext& job) {
    const Kept kept = splitKept(expansion, scene, lod.submeshes);
    Result<Work> work = planWork(expansion, scene, lod, kept);
    if (!work)
        return tl::unexpected(work.error());
    if (!runWork(*work, scene, job))
        return cancelled();
    Lod to;
    for (const std::uint32_t s : expansion.apart)
        to.submeshes.push_back({lod.submeshes[s].primitives,
                                renumbered(expansion, kept.apart[s]),
                                static_cast<std::uint32_t>(kept.apart[s].size())});
    for (std::shared_ptr<Geometry>& geometry : work->geometries)
        to.submeshes.push_back({{std::move(geometry)}, nullptr, 1});
    countLod(to);
    return to;
}

Result<ScenePtr> expandScene(const Scene& scene, const JobContext& job) {
    const Expansion expansion = planExpansion(scene);
    Result<Lod> lod = expandLod(expansion, scene, fullLod(scene), job);
    if (!lod)
        return tl::unexpected(lod.error());
    Scene& expanded = *expansion.skeleton;
    for (std::size_t s = expansion.first_merged; s < expanded.submeshes.size(); ++s)
        expanded.submeshes[s].primitives[0].geometry = lod->submeshes[s].primitives[0];
    job.report(1.0);
    return expansion.skeleton;
}

} // namespace lodestone
