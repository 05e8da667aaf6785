#pragma once
// The attributes of a submesh as the collapse engine keeps them: floats of wedges.
#include "simplify/collapse/chart_mask.h"
#include "simplify/collapse/complex.h"

#include <array>

namespace lodestone {

// Float attributes of wedges that are interpolated (normals, texture coordinates, colours, morph
// targets, joints with their weights); the rest is taken from the nearest original wedge.
// Tangents are carried, not rebuilt: the file's directions (MikkTSpace as a rule) are blended and
// made unit again, and the sign of the bitangent is the nearer wedge's. Only wedges that meet in a
// face become one, so signs stay apart along the seam of a mirrored texture.
struct WedgeAttributes {
    std::uint32_t size = 0;    // floats a wedge
    std::vector<float> values; // [wedges * size], all wedges of the complex

    enum class Kind : std::uint8_t {
        Plain, // blended value by value
        Normal,
        Tangent, // xyz unit, w a sign
        Texcoord,
        Color,
        Skin,    // joints or weights: see SkinSet
        Carried, // of the nearest original wedge
    };

    struct Slot {
        Kind kind = Kind::Carried;
        std::uint32_t offset = 0;
        std::uint32_t components = 0; // 0: Carried
        bool moves = false;           // it moves the vertex: positions of a morph target
        std::array<float, 4> low{};   // what the file's values span
        std::array<float, 4> high{};
    };

    // JOINTS_n and WEIGHTS_n: four influences.
    struct SkinSet {
        std::uint32_t joints = 0; // offsets
        std::uint32_t weights = 0;
    };

    struct PrimitiveLayout {
        std::vector<Slot> slots;                    // [attributes]
        std::vector<std::vector<Slot>> morph_slots; // [targets][attributes]
        std::vector<SkinSet> skin;
    };

    std::vector<PrimitiveLayout> primitives;
    bool carries = false; // some attribute is Carried
    double spacing = 0.0; // root of two faces' mean area: about the length of an edge

    // How morph targets and joints move a wedge, in the submesh's units: sums with random signs,
    // so that differences have the length that all motions' differences have together, on average.
    static constexpr std::size_t kMotionValues = 3;
    std::vector<float> motion; // [wedges * kMotionValues]; empty: nothing moves

    std::vector<std::uint32_t> extremes; // welded vertices that keep their place, rising
    double area = 0.0;                   // of all faces

    // What a primitive's first texture coordinates cover.
    struct Charts {
        ChartMask mask;
        std::uint32_t offset = 0; // of the coordinates among a wedge's values
    };

    std::vector<Charts> charts; // [primitives]; empty: none, or not looked at
};

// Layout and values of a submesh's attributes.
WedgeAttributes gatherAttributes(const Submesh& submesh, const Complex& complex);

// [primitives] Of those without texture coordinates a mask that holds everything; empty if none has
// any.
// O(faces + primitives).
std::vector<WedgeAttributes::Charts> gatherCharts(const Complex& complex,
                                                  const WedgeAttributes& attributes);

// Moves the influences at `into` by t, 0..1, towards those at `from`: joints of both, the
// strongest kept, weights summing to 1. values: of both wedges, offsets from sets.
void blendSkin(float* into,
               const float* from,
               float t,
               std::span<const WedgeAttributes::SkinSet> sets);

} // namespace lodestone
