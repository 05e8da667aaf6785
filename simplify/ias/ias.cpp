#include "simplify/ias/ias.h"

#include "simplify/collapse/prepare.h"

namespace lodestone {

Algorithm iasAlgorithm() {
    Algorithm row;
    row.id = "ias";
    row.name = "Instance-aware (IAS)";
    row.short_name = "IAS";
    row.paper = "Azim, Cheslack-Postava and Levis 2015";
    row.summary =
        "Collapses submesh edges by the error that all instances would show; instancing and "
        "its small file stay.";
    row.parameters = collapseParameters();
    row.parameters.push_back(removalParameter());
    row.parameters.push_back(removalRuleParameter());
    row.prepare = prepareSubmeshes<iasAlgorithm, Weighing::ByInstances>;
    return row;
}

} // namespace lodestone
