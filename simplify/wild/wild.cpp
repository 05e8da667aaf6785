#include "simplify/wild/wild.h"

#include "simplify/bake/bake_parameters.h"
#include "simplify/collapse/collapse_method.h"
#include "simplify/collapse/parameters.h"
#include "simplify/collapse/prepare.h"
#include "simplify/wild/virtual_edges.h"
#include "simplify/wild/wild_mesh.h"

namespace lodestone {

namespace {

class WildCollapser final : public ComponentCollapser {
public:
    WildCollapser(const Complex& complex,
                  const SequenceRequest& request,
                  const WedgeAttributes& attributes,
                  const CollapseOptions& options,
                  WildOptions wild)
        : wild_(std::move(wild)), mesh_(complex, request.weights, attributes, options, wild_),
          order_{wild_.checks ? Strictness::Manifold : Strictness::Anything,
                 options.near_greedy_above,
                 options.exact_below} {}

    bool collapse(std::size_t component, const CollapseWatch& watch) override {
        mesh_.load(component);
        return collapseLazily(mesh_, order_, watch);
    }

    ComponentMesh& mesh() override { return mesh_; }

private:
    WildOptions wild_;
    WildMesh mesh_;
    LazyGreedyOptions order_;
};

class WildMethod final : public CollapseMethod {
public:
    WildMethod(ScenePtr scene, const WildOptions& wild, const VirtualEdgeOptions& virtual_edges)
        : scene_(std::move(scene)), wild_(wild), virtual_edges_(virtual_edges) {}

    void arrange(Complex& complex,
                 const SequenceRequest& /*request*/,
                 const JobContext& job) const override {
        addVirtualEdges(complex, virtual_edges_, job);
    }

    std::unique_ptr<ComponentCollapser> collapser(const Complex& complex,
                                                  const SequenceRequest& request,
                                                  const WedgeAttributes& attributes,
                                                  const CollapseOptions& options) const override {
        WildOptions wild = wild_;
        for (const Primitive& primitive : request.submesh->primitives)
            wild.two_sided.push_back(primitive.material != kNone &&
                                     scene_->materials[primitive.material].double_sided);
        return std::make_unique<WildCollapser>(
            complex, request, attributes, options, std::move(wild));
    }

private:
    ScenePtr scene_;
    WildOptions wild_;
    VirtualEdgeOptions virtual_edges_;
};

enum class Scope : std::uint8_t { Auto, Submesh, Expanded };

bool expands(const Scene& scene, Scope scope) {
    return scope == Scope::Auto ? instancesPerSubmesh(scene) < kFewInstances
                                : scope == Scope::Expanded;
}

Result<LodSourcePtr> prepareWild(const ScenePtr& scene,
                                 const ParameterValues& values,
                                 const ScheduleOptions& schedule,
                                 const JobContext& job) {
    const Algorithm row = wildAlgorithm();
    if (const Result<void> checked = checkParameters(row, values); !checked)
        return tl::unexpected(checked.error());
    const auto value = [&](std::string_view id) { return parameterValue(row, values, id); };
    CollapseInput input{scene, schedule};
    EdgeCollapseOptions options;
    options.remove_instances = value("remove-instances") > 0.5;
    options.floors.enabled = value("floors") > 0.5;
    if (expands(*scene, static_cast<Scope>(value("scope")))) {
        Result<CollapseInput> expanded = expandInput(*scene, schedule, job);
        if (!expanded)
            return tl::unexpected(expanded.error());
        input = std::move(*expanded);
        options.remove_instances = false;
    }
    WildOptions wild;
    wild.area_weight = value("area");
    wild.checks = value("checks") > 0.5;
    VirtualEdgeOptions virtual_edges;
    virtual_edges.epsilon = value("epsilon") / 100.0;
    virtual_edges.rule = static_cast<VirtualEdgeRule>(value("virtual-edges"));
    options.collapse.grow_crowds = value("crowds") > 0.5;
    options.collapse.boundary_weight = 0.0; // the area term stands in for it
    options.collapse.attributes = {0.0, 0.0, 0.0};
    options.collapse.method = std::make_shared<const WildMethod>(input.scene, wild, virtual_edges);
    return prepareEdgeCollapse(input.scene, options, input.schedule, job);
}

ParameterInfo number(std::string_view id, double maximum, double fallback) {
    ParameterInfo info;
    info.id = id;
    info.maximum = maximum;
    info.fallback = fallback;
    return info;
}

ParameterInfo choice(std::string_view id, std::vector<std::string_view> choices) {
    ParameterInfo info;
    info.id = id;
    info.kind = ParameterInfo::Kind::Choice;
    info.choices = std::move(choices);
    return info;
}

std::vector<ParameterInfo> wildParameters() {
    ParameterInfo epsilon = number("epsilon", 5.0, 0.0);
    epsilon.label = "Merge distance";
    epsilon.unit = "% of the diagonal";
    epsilon.tooltip =
        "Separate parts that come nearer than this may merge; 0: none, which measured best on "
        "most models and is fastest. Some .1 % keeps touching parts of a building together.";
    ParameterInfo rule = choice("virtual-edges", {"triangles", "vertices"});
    rule.label = "Near is measured";
    rule.tooltip = "Between triangles, or between vertices as Garland and Heckbert do.";
    ParameterInfo area = number("area", 100.0, 1.0);
    area.label = "Area weight";
    area.tooltip = "How firmly open borders keep the area inside them.";
    ParameterInfo checks = number("checks", 1.0, 0.0);
    checks.kind = ParameterInfo::Kind::Toggle;
    checks.label = "Validity checks";
    checks.tooltip = "Keep topology and turn no face over: for input known to be manifold.";
    ParameterInfo scope = choice("scope", {"auto", "submesh", "expanded"});
    scope.label = "Scope";
    scope.tooltip = "Submesh by submesh, weighted by their instances, or all instances of a "
                    "material as one; auto: by submesh where the scene is instanced.";
    ParameterInfo floors = number("floors", 1.0, 1.0);
    floors.kind = ParameterInfo::Kind::Toggle;
    floors.label = "Floors";
    floors.tooltip = "Keep at least four triangles and most of the extent of every submesh.";
    ParameterInfo crowds = number("crowds", 1.0, 1.0);
    crowds.kind = ParameterInfo::Kind::Toggle;
    crowds.label = "Crowds keep their area";
    crowds.tooltip = "Where many small open parts, such as leaves, become few, those few grow so "
                     "that together they cover as much as before.";
    std::vector<ParameterInfo> parameters{
        epsilon, rule, area, checks, crowds, scope, floors, removalParameter()};
    addBakeParameters(parameters);
    return parameters;
}

} // namespace

Algorithm wildAlgorithm() {
    Algorithm row;
    row.id = "wild";
    row.name = "Wild";
    row.short_name = "Wild";
    row.paper = "Liu et al. 2024";
    row.summary =
        "Takes any triangles, keeps the area of open borders and can merge separate parts.";
    row.parameters = wildParameters();
    row.prepare = prepareWild;
    return row;
}

} // namespace lodestone
