#include "app/lane_slide.h"

#include "app/lod_position.h"

#include <algorithm>
#include <cmath>

namespace lodestone {

namespace {

constexpr double kLevelRatio = 0.8; // of the triangles of two LODs that vertices slide between
constexpr double kSmallestRatio = 1e-6;

} // namespace

std::shared_ptr<const Lod> LaneSlide::at(const LodSourcePtr& source, double ratio) {
    const auto* const geomorphs = dynamic_cast<const GeomorphSource*>(source.get());
    if (!geomorphs)
        return nullptr;
    const double along = std::log(std::clamp(ratio, kSmallestRatio, 1.0)) / std::log(kLevelRatio);
    const double level = std::floor(along);
    if (source_ != source || level_ != level) {
        const auto full = static_cast<double>(source->trianglesAt(0));
        const auto position = [&](double at_level) {
            return finestWithin(*source, full * std::pow(kLevelRatio, at_level));
        };
        geomorph_ = geomorphs->geomorph(position(level), position(level + 1.0));
        source_ = source;
        level_ = level;
    }
    return std::make_shared<const Lod>(slid(geomorph_, along - level));
}

} // namespace lodestone
