#include "simplify/collapse/parameters.h"

namespace lodestone {

namespace {

constexpr std::string_view kShapeFloor = "shape-floor";

ParameterInfo weightParameter(std::string_view id,
                              std::string_view label,
                              std::string_view tooltip,
                              double fallback) {
    ParameterInfo weight;
    weight.id = id;
    weight.label = label;
    weight.tooltip = tooltip;
    weight.maximum = 100.0;
    weight.fallback = fallback;
    return weight;
}

void addAttributeWeights(std::vector<ParameterInfo>& parameters) {
    const AttributeWeights weights;
    parameters.push_back(weightParameter(
        "uv-weight",
        "Texture weight",
        "How firmly textures stay in place. 1: sliding by some way counts as a surface that is off "
        "by as much. 0: texture coordinates are only carried along.",
        weights.texcoord));
    parameters.push_back(weightParameter(
        "normal-weight",
        "Shading weight",
        "How much shading normals count. 1: a radian counts as a surface that is off by an edge's "
        "length. 0: they are only carried along.",
        weights.normal));
    parameters.push_back(weightParameter(
        "color-weight",
        "Colour weight",
        "How much vertex colours count. 1: black for white counts as a surface that is off by an "
        "edge's length. 0: they are only carried along.",
        weights.color));
    parameters.push_back(weightParameter("motion-weight",
                                         "Motion weight",
                                         "How much morph targets and joints count. 1: a surface "
                                         "that is off while it moves counts as "
                                         "one off at rest. 0: they are only carried along.",
                                         weights.motion));
}

ParameterInfo removalRuleParameter() {
    ParameterInfo rule;
    rule.id = "removal-rule";
    rule.label = "Removal rule";
    rule.tooltip = "Instances go when that costs less than collapsing on or, as the paper has it, "
                   "once nothing is left to collapse, of submeshes with 5 % of all instances or "
                   "1,000.";
    rule.kind = ParameterInfo::Kind::Choice;
    rule.choices = {"by-cost", "paper"};
    return rule;
}

} // namespace

std::vector<ParameterInfo> collapseParameters() {
    std::vector<ParameterInfo> parameters(3);
    ParameterInfo& boundary = parameters[0];
    boundary.id = "boundary";
    boundary.label = "Boundary weight";
    boundary.unit = "x e\xc2\xb2";
    boundary.tooltip = "How firmly open borders stay in place: factor on the squared edge length.";
    boundary.maximum = 100.0;
    boundary.fallback = 1.0;
    ParameterInfo& rule = parameters[1];
    rule.id = "boundary-rule";
    rule.label = "Boundary rule";
    rule.tooltip =
        "Borders weighted by squared edge length (independent of the scene's scale) or, as "
        "the paper has it, by edge length.";
    rule.kind = ParameterInfo::Kind::Choice;
    rule.choices = {"squared-length", "length"};
    ParameterInfo& flip = parameters[2];
    flip.id = "flip-angle";
    flip.label = "Flip limit";
    flip.unit = "\xc2\xb0";
    flip.tooltip = "Collapses that turn a face by more than this are rejected.";
    flip.minimum = 10.0;
    flip.maximum = 180.0;
    flip.fallback = 80.0;
    addAttributeWeights(parameters);
    ParameterInfo seams;
    seams.id = "seams";
    seams.label = "Seams permissive";
    seams.tooltip =
        "What may happen to corners and ends of texture, normal, colour and material seams. 0: "
        "strict, they stay. 1: permissive, they go where that costs least. Between: it costs as "
        "many times more.";
    seams.fallback = CollapseOptions{}.seams;
    parameters.push_back(seams);
    parameters.push_back(weightParameter(
        "silhouette-weight",
        "Silhouette weight",
        "How firmly outlines stay in place: edges count by the share of directions that see them "
        "as part of the outline. 1: as much as an open border there. 0: no more than the rest.",
        CollapseOptions{}.silhouette_weight));
    return parameters;
}

ParameterInfo removalParameter() {
    ParameterInfo removal;
    removal.id = "remove-instances";
    removal.label = "Remove instances";
    removal.tooltip =
        "Below a submesh's floor, thin out its instances and grow the rest so that the "
        "area stays.";
    removal.kind = ParameterInfo::Kind::Toggle;
    removal.fallback = 1.0;
    return removal;
}

void addRemovalParameters(std::vector<ParameterInfo>& parameters) {
    parameters.push_back(removalParameter());
    parameters.push_back(removalRuleParameter());
    ParameterInfo floor;
    floor.id = kShapeFloor;
    floor.label = "Shape floor";
    floor.tooltip =
        "Share of every axis that a submesh of 16 or more instances keeps, and 5/8 of it of "
        "its area; below it instances go. 0.8: leaves keep their shape and grow fewer. "
        "0: shapes get as coarse as they can before any goes.";
    floor.fallback = FloorOptions{}.min_shape;
    parameters.push_back(floor);
}

Result<EdgeCollapseOptions> readCollapseParameters(const Algorithm& algorithm,
                                                   const ParameterValues& values) {
    if (const Result<void> checked = checkParameters(algorithm, values); !checked)
        return tl::unexpected(checked.error());
    EdgeCollapseOptions options;
    options.collapse.boundary_weight = parameterValue(algorithm, values, "boundary");
    options.collapse.boundary_by_length = parameterValue(algorithm, values, "boundary-rule") > 0.5;
    options.collapse.flip_angle_deg = parameterValue(algorithm, values, "flip-angle");
    AttributeWeights& weights = options.collapse.attributes;
    weights.texcoord = parameterValue(algorithm, values, "uv-weight");
    weights.normal = parameterValue(algorithm, values, "normal-weight");
    weights.color = parameterValue(algorithm, values, "color-weight");
    weights.motion = parameterValue(algorithm, values, "motion-weight");
    options.collapse.silhouette_weight = parameterValue(algorithm, values, "silhouette-weight");
    options.collapse.seams = parameterValue(algorithm, values, "seams");
    options.remove_instances = parameterValue(algorithm, values, "remove-instances") > 0.5;
    options.remove_by_paper = parameterValue(algorithm, values, "removal-rule") > 0.5;
    options.floors.min_shape = parameterValue(algorithm, values, kShapeFloor);
    return options;
}

} // namespace lodestone
