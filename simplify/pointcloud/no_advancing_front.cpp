// A build without CGAL.
#include "simplify/pointcloud/advancing_front.h"

namespace lodestone {

bool canRebuildFromPoints() {
    return false;
}

void rebuildFromPoints(CloudSurface&) {}

} // namespace lodestone
