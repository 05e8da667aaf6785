#pragma once
// A scene's submeshes ready for the methods, and the ladder of values of a main parameter.
#include "simplify/pointcloud/cloud_submesh.h"

namespace lodestone {

// What does not depend on a method or its parameters: shared by all sources of a scene.
struct CloudScene {
    ScenePtr scene;
    std::vector<CloudSubmesh> submeshes; // [scene.submeshes]
    double diagonal = 1.0;               // > 0
    double edge_length = 0.0;            // typical one of what is drawn, % of the diagonal
};

using CloudScenePtr = std::shared_ptr<const CloudScene>;

// Welds every submesh, all at once. O(vertices + faces + instances). Stops early where asked to:
// the caller looks at the job and drops what it got.
CloudScenePtr makeCloudScene(ScenePtr scene, const JobContext& job);

// Rung 0 is the scene itself, rising rungs have rising values; above kRungs further passes follow.
class CloudLadder {
public:
    static constexpr std::uint64_t kRungs = 4096;

    explicit CloudLadder(const CloudMethod& method) : method_(&method) {}

    std::uint64_t last() const { return kRungs + method_->further_passes; }

    // Of the main parameter; distances in % of the diagonal.
    double valueOf(std::uint64_t rung) const;
    // The lowest rung whose value is at least that.
    std::uint64_t rungOf(double value) const;
    // base with the rung's main parameter and passes.
    CloudSettings settingsOf(std::uint64_t rung, const CloudSettings& base) const;
    // Where a search for a target best begins, rising.
    std::vector<std::uint64_t> usualRungs(const CloudScene& scene) const;

private:
    const CloudMethod* method_;
};

} // namespace lodestone
