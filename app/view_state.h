#pragma once
// What all lanes share on screen: camera, light, shading, selection. Plain values; no GL.
#include "app/color_map.h"
#include "scene/pose.h"

#include <compare>
#include <optional>
#include <string_view>

namespace lodestone {

// Orbit camera. Azimuth 0 looks along -z from +z and turns counter-clockwise seen from above;
// elevation 0 is level, 90 looks straight down.
struct CameraState {
    double azimuth_deg = 35.0;
    double elevation_deg = 20.0;
    double distance = 0.0; // world units from target; 0: not framed yet
    glm::dvec3 target{0.0};
    bool orthographic = false; // height shown = the perspective's at the target

    friend bool operator==(const CameraState&, const CameraState&) = default;
};

enum class ShadingMode : std::uint8_t {
    Lit,
    Clay,
    Normals,
    Flat,
    UvChecker,
    Submesh,
    Instance,
    Matcap,
    LodState,
    Texels,
};
constexpr std::size_t kShadingModes = 10;
constexpr double kTexelSpan = 64.0; // from the first to the last colour of ShadingMode::Texels

std::string_view shadingName(ShadingMode shading);                 // "lit", "clay", ...
std::optional<ShadingMode> shadingFromName(std::string_view name); // nullopt if unknown

enum class CompareMode : std::uint8_t {
    Grid,
    Split,      // two lanes, a divider between them
    Flicker,    // two lanes, in turn at one place
    HeatMap,    // grid; every vertex in the colour of its distance to the original
    Difference, // grid; every pixel in the colour of its difference from the original's picture
};

std::string_view compareName(CompareMode compare); // "grid", "split", ...

enum class Backdrop : std::uint8_t { Dark, Gradient, Grey, Light };

// Whose mouse habits the views follow.
enum class Navigation : std::uint8_t { Lodestone, Blender, Maya };

struct DisplayOptions {
    ShadingMode shading = ShadingMode::Lit;
    bool wireframe = false;
    CompareMode compare = CompareMode::Grid;
    Backdrop backdrop = Backdrop::Dark;
    bool grid = false;                   // floor under the scene
    ColorMap colors = ColorMap::Viridis; // of heat map and difference
    double shininess = 1.0;              // divides roughness, 0.1..10
    Navigation navigation = Navigation::Lodestone;
    double light_azimuth_deg = 30.0; // relative to the camera
    double light_elevation_deg = 50.0;
    Moment moment; // of the scene's animations; at rest at first

    friend bool operator==(const DisplayOptions&, const DisplayOptions&) = default;
};

constexpr double kVerticalFovRad = 0.6; // of the orbit camera, full angle

// The camera turned as `camera` is, so near that `bounds` just fits the view. Empty bounds:
// unchanged.
CameraState framed(const CameraState& camera, const Bounds& bounds);

// A submesh, or one of its instances.
struct SelectedItem {
    std::uint32_t submesh = 0;
    std::uint32_t instance = kNone; // in Scene::instances; kNone: the whole submesh

    friend auto operator<=>(const SelectedItem&, const SelectedItem&) = default; // NOLINT
};

} // namespace lodestone
