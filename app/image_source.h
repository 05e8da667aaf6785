#pragma once
// Pixels for the command line. app/ knows no GL: main.cpp injects one made over render/.
#include "app/view_state.h"
#include "scene/job_context.h"
#include "scene/lod.h"
#include "scene/pose.h"
#include "scene/result.h"
#include "simplify/measure/image_difference.h"

#include <filesystem>
#include <functional>

namespace lodestone {

struct ImageColumn {
    ScenePtr scene; // whose submeshes `lod` replaces
    std::shared_ptr<const Lod> lod;
    std::string label; // "IAS 20 %"
};

struct OrbitView {
    double azimuth_deg = 0.0;
    double elevation_deg = 0.0;
    double distance = 0.0; // world units from the scene's centre; 0: frames the scene
};

struct RenderRequest {
    std::vector<ImageColumn> columns; // >= 1, side by side with one camera
    std::uint32_t width_px = 1280;    // of one column
    std::uint32_t height_px = 720;
    std::optional<OrbitView> orbit;           // neither this nor the next: the usual view
    std::optional<std::uint32_t> file_camera; // in Scene::cameras, in range
    ShadingMode shading = ShadingMode::Lit;
    bool wireframe = false;
    Moment moment;              // of the scenes' animations
    bool measure = false;       // also time each column
    std::filesystem::path path; // PNG, written atomically
};

struct RenderReport {
    std::uint32_t width_px = 0; // of the picture
    std::uint32_t height_px = 0;
    std::vector<double> frame_ms; // [columns] with `measure`: mean of the timed frames; else empty
    std::string renderer;         // GL_RENDERER
};

struct PictureRequest {
    std::vector<ImageColumn> columns; // >= 1; labels are not drawn
    std::vector<OrbitView> views;     // each framed for the first column's scene
    std::uint32_t width_px = 512;
    std::uint32_t height_px = 512;
    ShadingMode shading = ShadingMode::Lit;
};

// Which column and view of the request a picture shows.
struct PictureOrigin {
    std::size_t column = 0;
    std::size_t view = 0;
};

// What it fails with ends the drawing.
using PictureSink = std::function<Result<void>(PictureOrigin, Picture)>;

class ImageSource {
public:
    virtual ~ImageSource() = default;
    // Draws off screen and writes the PNG. Errors: Failed (no GL, disk), Cancelled. Main thread.
    virtual Result<RenderReport> render(const RenderRequest& request, const JobContext& job) = 0;
    // Draws off screen, column after column, each from all views in order, and hands every picture
    // over: over a plain background, alpha 0 where nothing else is seen. Errors: as render, or the
    // sink's. Main thread.
    virtual Result<void>
    draw(const PictureRequest& request, const PictureSink& sink, const JobContext& job) = 0;
};

} // namespace lodestone
