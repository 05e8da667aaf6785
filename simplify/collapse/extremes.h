#pragma once
// Which vertices a submesh needs to keep its box while it moves.
#include "simplify/collapse/wedge_attributes.h"

#include <memory>

namespace lodestone {

// How the file moves an instance of a submesh at one moment. World from submesh or skin space.
struct Posture {
    glm::mat4 transform{1.0f};                            // of vertices that no joint holds
    std::shared_ptr<const std::vector<glm::mat4>> joints; // null: no skin
    std::vector<float> weights;                           // of morph targets
};

// [submeshes] Of each that a skin or morph targets deform, how its first instance stands: at rest,
// at up to 64 moments spread evenly over all animations, and with each of up to 64 morph targets
// all the way. Empty for all others. O(nodes x moments). Any thread.
std::vector<std::vector<Posture>> deformingPostures(const Scene& scene);

// A few welded vertices, rising, that together reach each side of the submesh's box in every
// posture, to 0.25 % of its diagonal. Of large submeshes fewer postures count. Empty without
// postures. O(vertices x postures), a few million at most. Any thread, deterministic.
std::vector<std::uint32_t> extremeVertices(const Complex& complex,
                                           const WedgeAttributes& attributes,
                                           std::span<const Posture> postures);

} // namespace lodestone
