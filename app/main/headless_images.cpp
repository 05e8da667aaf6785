#include "app/main/headless_images.h"

#include "app/main/view_values.h"
#include "render/view.h"
#ifdef LODESTONE_WITH_WINDOW
#include "ui/fonts.h"
#endif

#include <numbers>

namespace lodestone {

namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

OrbitCamera cameraFor(const RenderRequest& request, const Bounds& bounds) {
    const double aspect = static_cast<double>(request.width_px) / request.height_px;
    if (request.file_camera)
        return cameraFromScene(request.columns[0].scene->cameras[*request.file_camera], bounds);
    OrbitCamera camera;
    if (request.orbit) {
        camera.azimuth_rad = request.orbit->azimuth_deg * kRadiansPerDegree;
        camera.elevation_rad = request.orbit->elevation_deg * kRadiansPerDegree;
    }
    frameCamera(camera, bounds, aspect);
    if (request.orbit && request.orbit->distance > 0.0)
        camera.distance = request.orbit->distance;
    return camera;
}

struct DrawnColumn {
    Pixels picture;
    double frame_ms = 0.0;
};

class HeadlessImages final : public ImageSource {
public:
    Result<RenderReport> render(const RenderRequest& request, const JobContext& job) override {
        auto context = createHeadlessContext();
        if (!context)
            return tl::unexpected<Error>(std::move(context.error()));
        const auto renderer = Renderer::create(**context);
        if (!renderer)
            return tl::unexpected<Error>(renderer.error());
        RenderReport report;
        report.renderer = (*context)->info().renderer;
        std::vector<SheetCell> cells;
        std::optional<OrbitCamera> camera;
        for (const ImageColumn& column : request.columns) {
            if (job.stopRequested())
                return cancelled();
            auto drawn = drawColumn(*renderer, request, column, camera);
            if (!drawn)
                return tl::unexpected<Error>(std::move(drawn.error()));
            if (request.measure)
                report.frame_ms.push_back(drawn->frame_ms);
            cells.push_back({std::move(drawn->picture), column.label});
            job.report(static_cast<double>(cells.size()) /
                       static_cast<double>(request.columns.size()));
        }
        return writePicture(request, cells, std::move(report));
    }

private:
    // camera: made for the first column, kept for the others.
    static Result<DrawnColumn> drawColumn(const Renderer& renderer,
                                          const RenderRequest& request,
                                          const ImageColumn& column,
                                          std::optional<OrbitCamera>& camera) {
        auto scene = GpuScene::create(renderer, column.scene);
        if (!scene)
            return tl::unexpected<Error>(std::move(scene.error()));
        LodHandle lod;
        if (const auto uploaded = scene->update(lod, *column.lod); !uploaded)
            return tl::unexpected<Error>(uploaded.error());
        auto view = View::create(renderer);
        if (!view)
            return tl::unexpected<Error>(std::move(view.error()));
        if (!camera)
            camera = cameraFor(request, scene->bounds());
        View::Input input;
        input.scene = &*scene;
        input.lod = &lod;
        input.camera = *camera;
        input.options.shading = shadingFor(request.shading);
        input.options.wireframe = request.wireframe;
        input.size = {static_cast<int>(request.width_px), static_cast<int>(request.height_px)};
        if (const auto drawn = view->draw(input); !drawn)
            return tl::unexpected<Error>(drawn.error());
        DrawnColumn result;
        if (request.measure) {
            constexpr double kMeasureBudgetSeconds =
                10.0; // software renderers need minutes otherwise
            const auto measured = view->measure(input, {100, 1000, kMeasureBudgetSeconds});
            if (!measured)
                return tl::unexpected<Error>(measured.error());
            result.frame_ms = measured->mean_ms;
        }
        auto picture = view->readPixels();
        if (!picture)
            return tl::unexpected<Error>(std::move(picture.error()));
        result.picture = std::move(*picture);
        return result;
    }

    static Result<RenderReport> writePicture(const RenderRequest& request,
                                             const std::vector<SheetCell>& cells,
                                             RenderReport report) {
        Result<Pixels> sheet = cells[0].picture;
        if (cells.size() > 1) {
            SheetOptions options;
#ifdef LODESTONE_WITH_WINDOW
            options.font = ui::systemFontFile();
#endif
            sheet = composeSheet(cells, options);
        }
        if (!sheet)
            return tl::unexpected<Error>(std::move(sheet.error()));
        if (const auto written = writePng(request.path, *sheet); !written)
            return tl::unexpected<Error>(written.error());
        report.width_px = sheet->width;
        report.height_px = sheet->height;
        return report;
    }
};

} // namespace

std::unique_ptr<ImageSource> makeHeadlessImages() {
    return std::make_unique<HeadlessImages>();
}

} // namespace lodestone
