#pragma once
// The image difference between LODs: the same cameras for all of them, drawn by the ImageSource.
#include "app/image_source.h"
#include "simplify/measure/image_difference.h"

#include <array>
#include <span>

namespace lodestone {

// Twelve directions spread evenly (the corners of an icosahedron), each framing the scene.
std::array<OrbitView, 12> measuringViews();

struct ImageMeasureOptions {
    std::uint32_t size_px = 512; // width and height of each picture
    ImageDifferenceOptions difference;
};

// Draws every column from measuringViews(), framed for the first one, and compares the others with
// it. Result: [columns.size() - 1], result[i] belongs to columns[i + 1], with cameras = 12.
// Errors: those of the source and of comparePictures; Cancelled. Main thread (it draws).
Result<std::vector<ImageDifference>> measureImages(ImageSource& images,
                                                   std::span<const ImageColumn> columns,
                                                   const ImageMeasureOptions& options,
                                                   const JobContext& job);

} // namespace lodestone
