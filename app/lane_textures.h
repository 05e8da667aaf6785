#pragma once
// What transfer of textures has made of a lane's LOD, and its textures before and after as small
// pictures.
#include "scene/job_context.h"
#include "scene/lod.h"
#include "simplify/lod_source.h"

namespace lodestone {

// RGBA, 8 bits a channel as the image has them, top row first.
struct ImagePreview {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> rgba; // [4 * width * height]; empty: the image cannot be shown

    bool empty() const { return rgba.empty(); }
};

// The base colour of one atlas beside what it was made from; halved until no side is longer than
// LaneTextures::kPreviewSide.
struct AtlasPreview {
    std::string name; // of the material
    ImagePreview before;
    ImagePreview after;
    std::uint32_t before_px = 0; // width of the images themselves
    std::uint32_t after_px = 0;
    double texels_per_unit = 0.0;          // as in BakedAtlas
    double original_texels_per_unit = 0.0; // as in BakedAtlas
};

// Immutable once made; shared by the document, jobs and pictures.
struct LaneTextures {
    BakedScene baked;
    std::shared_ptr<const Lod> lod;     // full, of baked.scene
    BakeOptions options;                // it was made with
    std::uint64_t lod_revision = 0;     // of the lane's LOD that it was made from
    std::vector<AtlasPreview> previews; // of the first kMostPreviews atlases

    static constexpr std::size_t kMostPreviews = 16;
    static constexpr std::uint32_t kPreviewSide = 1024;
};

using LaneTexturesPtr = std::shared_ptr<const LaneTextures>;

struct LaneTexturesInput {
    LodSourcePtr source;
    std::shared_ptr<const Lod> lod; // read out from it
    BakeOptions options;
    std::uint64_t lod_revision = 0;
};

// Errors: those of LodSource::transferred. Any thread.
Result<LaneTexturesPtr> makeLaneTextures(const LaneTexturesInput& input, const JobContext& job);

} // namespace lodestone
