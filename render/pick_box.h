#pragma once
// What is in a box of a view. On the CPU, when a box has been dragged only.
#include "render/view.h"

namespace lodestone {

// Of a view: 0..1 from the left, 0..1 from the top; min <= max.
struct PickBox {
    glm::dvec2 min{0.0};
    glm::dvec2 max{1.0};
};

// The instances that have a vertex in the box, those behind others, too; by submesh, then by
// instance. Hidden submeshes are left out. Parallel, same result on any number of threads; needs no
// current context. Cost: O(instanced vertices).
std::vector<Highlight> pickBox(const View::Input& input, const PickBox& box);

} // namespace lodestone
