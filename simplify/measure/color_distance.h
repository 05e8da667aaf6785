#pragma once
// How far the colours of two scenes' surfaces are apart.
#include "simplify/measure/distance.h"

namespace lodestone {

// Colours are what an unlit picture shows: base colour texture (filtered, wrapped, sRGB made
// linear) x base colour factor x vertex colour, made sRGB again; each channel 0..1. Alpha does not
// count.
struct ColorDistance {
    double mean = 0.0; // symmetric colour Chamfer distance: the average of the next two; 0..sqrt(3)
    double a_to_b = 0.0; // mean length of the RGB difference to the closest point of the other
    double b_to_a = 0.0;
    std::uint64_t samples = 0;      // in all
    std::vector<std::string> notes; // images that could not be read and count as white
};

// Area-weighted samples of both surfaces as in measureDistance; each is compared with the closest
// point of the other surface, by position. Deterministic for any number of threads. Errors as
// measureDistance. Any thread, parallel; O(samples log triangles); decodes the images of both
// scenes. Source: Wild (Liu et al. 2024) 9.2.
Result<ColorDistance> measureColorDistance(const LodView& a,
                                           const LodView& b,
                                           const DistanceOptions& options,
                                           const JobContext& job);

} // namespace lodestone
