#pragma once
// A method as the source sees it: settings in, simplified surface out.
#include "simplify/pointcloud/methods.h"

namespace lodestone {

// What the parameter that drives a method stands for.
enum class MainParameter : std::uint8_t {
    Coverage,    // passes over the triangles, fractional
    AngleDeg,    // between the faces around a vertex
    DistancePct, // % of the scene's diagonal
};

enum class Retriangulation : std::uint8_t {
    Surface,    // the input's own triangles, merged and flipped to Delaunay
    PointCloud, // rebuilt from the points alone
};

struct CloudSettings {
    double main = 0.0;        // Coverage: passes; AngleDeg: degrees; DistancePct: surface units
    std::uint32_t passes = 1; // where the main parameter is no coverage
    double angle_deg = 30.0;  // FASS: of its first step
    double area_share = 1.0;  // FAD: largest area around a removed vertex, of the whole surface's
    Fidelity fidelity = Fidelity::Sound;
    Retriangulation retriangulation = Retriangulation::Surface;
};

struct CloudMethod {
    MainParameter main = MainParameter::DistancePct;
    std::string_view main_id; // "radius"
    double maximum = 100.0;   // of the main parameter
    // Passes that follow at the maximum where a target asks for more; 0: one pass reaches it all.
    std::uint32_t further_passes = 0;
    // Where about 40 % and 10 % of an even surface's triangles are left: where a search for a
    // target begins. Distances in typical edges.
    std::array<double, 2> usual{0.0, 0.0};
    // Leaves the surface as it is where main is 0, and the last flips to the caller: they change no
    // count. Stops early where asked to.
    void (*run)(CloudSurface& surface,
                const Complex& complex,
                const CloudSettings& settings,
                const JobContext& job) = nullptr;
    // What it never takes away, for the note on a target it cannot reach.
    std::string_view keeps = "at least 4 a submesh; no face turns over unless 'literal' is set";
};

// VT, FAD, IVDD, SS, VTD, FASS.
extern const CloudMethod kVertexTriplexMethod;
extern const CloudMethod kFaceAngleMethod;
extern const CloudMethod kIntervertexDistanceMethod;
extern const CloudMethod kSphericalScanningMethod;
extern const CloudMethod kVertexTriplexDistanceMethod;
extern const CloudMethod kFaceAngleScanningMethod;

} // namespace lodestone
