#pragma once
// Where edge-collapse methods differ beyond options: what may merge, and how one component is
// collapsed. Joining, floors, schedule and read-out are the same for all.
#include "simplify/collapse/sequence.h"

#include <memory>

namespace lodestone {

// One worker's; keeps its memory from one component to the next.
class ComponentCollapser {
public:
    virtual ~ComponentCollapser() = default;

    // Collapses a component until nothing is left to collapse; the log is the mesh's. False if
    // stopped.
    virtual bool collapse(std::size_t component, const CollapseWatch& watch) = 0;
    virtual ComponentMesh& mesh() = 0;
};

// Immutable; any number of threads.
class CollapseMethod {
public:
    virtual ~CollapseMethod() = default;

    // May join components and add virtual edges. Stops early where asked to.
    virtual void
    arrange(Complex& complex, const SequenceRequest& request, const JobContext& job) const = 0;
    // The arguments outlive the result.
    virtual std::unique_ptr<ComponentCollapser> collapser(const Complex& complex,
                                                          const SequenceRequest& request,
                                                          const WedgeAttributes& attributes,
                                                          const CollapseOptions& options) const = 0;
};

} // namespace lodestone
