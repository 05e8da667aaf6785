#include "app/image_measure.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace lodestone {

std::array<OrbitView, 12> measuringViews() {
    // (0, +-1, +-g), (+-1, +-g, 0), (+-g, 0, +-1), y up: three belts of four.
    const double low_deg = std::atan2(1.0, std::numbers::phi) * 180.0 / std::numbers::pi;
    const double high_deg = 90.0 - low_deg;
    std::array<OrbitView, 12> views;
    std::size_t next = 0;
    for (const double up : {1.0, -1.0}) {
        for (const double azimuth_deg : {0.0, 180.0})
            views[next++] = {azimuth_deg, up * low_deg};
        for (const double azimuth_deg : {90.0, 270.0})
            views[next++] = {azimuth_deg, up * high_deg};
    }
    for (const double azimuth_deg :
         {90.0 - low_deg, 90.0 + low_deg, 270.0 - low_deg, 270.0 + low_deg})
        views[next++] = {azimuth_deg, 0.0};
    assert(next == views.size());
    return views;
}

Result<std::vector<ImageDifference>> measureImages(ImageSource& images,
                                                   std::span<const ImageColumn> columns,
                                                   const ImageMeasureOptions& options,
                                                   const JobContext& job) {
    const auto views = measuringViews();
    PictureRequest request;
    request.columns.assign(columns.begin(), columns.end());
    request.views.assign(views.begin(), views.end());
    request.width_px = options.size_px;
    request.height_px = options.size_px;
    std::vector<Picture> references;                                 // [views]
    std::vector<std::vector<ImageDifference>> pairs(columns.size()); // [columns][views]
    JobContext comparing;
    comparing.stop = job.stop;
    const auto take = [&](PictureOrigin origin, Picture picture) -> Result<void> {
        if (origin.column == 0) {
            references.push_back(std::move(picture));
            return {};
        }
        Result<ImageDifference> pair =
            comparePictures(references[origin.view], picture, options.difference, comparing);
        if (!pair)
            return tl::unexpected<Error>(std::move(pair.error()));
        pairs[origin.column].push_back(*pair);
        return {};
    };
    if (Result<void> drawn = images.draw(request, take, job); !drawn)
        return tl::unexpected<Error>(std::move(drawn.error()));
    std::vector<ImageDifference> differences;
    for (std::size_t column = 1; column < columns.size(); ++column)
        differences.push_back(combined(pairs[column]));
    return differences;
}

} // namespace lodestone
