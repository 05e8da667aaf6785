#include "app/main/headless_images.h"

#include "app/main/view_values.h"
#include "render/view.h"
#ifdef LODESTONE_WITH_WINDOW
#include "ui/fonts.h"
#endif

#include <cmath>
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

    Result<void>
    draw(const PictureRequest& request, const PictureSink& sink, const JobContext& job) override {
        auto context = createHeadlessContext();
        if (!context)
            return tl::unexpected<Error>(std::move(context.error()));
        const auto renderer = Renderer::create(**context);
        if (!renderer)
            return tl::unexpected<Error>(renderer.error());
        auto view = View::create(*renderer);
        if (!view)
            return tl::unexpected<Error>(std::move(view.error()));
        std::vector<OrbitCamera> cameras;
        for (std::size_t column = 0; column < request.columns.size(); ++column) {
            const auto uploaded = upload(*renderer, request.columns[column]);
            if (!uploaded)
                return tl::unexpected<Error>(uploaded.error());
            if (column == 0)
                cameras = framedCameras(request, uploaded->scene.framePoints());
            View::Input input;
            input.scene = &uploaded->scene;
            input.lod = &uploaded->lod;
            input.options = shadedOptions(request.shading, *request.columns.front().scene);
            input.options.background = Background::Transparent; // drawPicture puts it under
            input.size = {static_cast<int>(request.width_px), static_cast<int>(request.height_px)};
            for (std::size_t v = 0; v < cameras.size(); ++v) {
                if (job.stopRequested())
                    return cancelled();
                input.camera = cameras[v];
                Result<Picture> picture = drawPicture(*view, input);
                if (!picture)
                    return tl::unexpected<Error>(std::move(picture.error()));
                if (Result<void> taken = sink({column, v}, std::move(*picture)); !taken)
                    return taken;
                job.report(static_cast<double>(column * cameras.size() + v + 1) /
                           static_cast<double>(request.columns.size() * cameras.size()));
            }
        }
        return {};
    }

private:
    struct Uploaded {
        GpuScene scene;
        LodHandle lod;
    };

    static Result<Uploaded> upload(const Renderer& renderer, const ImageColumn& column) {
        auto scene = GpuScene::create(renderer, column.scene);
        if (!scene)
            return tl::unexpected<Error>(std::move(scene.error()));
        LodHandle lod;
        if (const auto uploaded = scene->update(lod, *column.lod); !uploaded)
            return tl::unexpected<Error>(uploaded.error());
        return Uploaded{std::move(*scene), std::move(lod)};
    }

    // The directions of the views, each with the points framed.
    static std::vector<OrbitCamera> framedCameras(const PictureRequest& request,
                                                  const FramePoints& points) {
        std::vector<OrbitCamera> cameras;
        for (const OrbitView& view : request.views) {
            OrbitCamera camera;
            camera.azimuth_rad = view.azimuth_deg * kRadiansPerDegree;
            camera.elevation_rad = view.elevation_deg * kRadiansPerDegree;
            frameCamera(camera, points, static_cast<double>(request.width_px) / request.height_px);
            if (view.distance > 0.0)
                camera.distance = view.distance;
            cameras.push_back(camera);
        }
        return cameras;
    }

    // The colours over a background; alpha stays.
    static void putUnder(const glm::vec3& background_srgb, std::vector<std::uint8_t>& rgba) {
        for (std::size_t i = 0; i < rgba.size(); i += 4) {
            const float alpha = static_cast<float>(rgba[i + 3]) / 255.0f;
            for (int c = 0; c < 3; ++c) {
                std::uint8_t& byte = rgba[i + static_cast<std::size_t>(c)];
                const float under = 255.0f * background_srgb[c];
                byte = static_cast<std::uint8_t>(
                    std::lround(alpha * static_cast<float>(byte) + (1.0f - alpha) * under));
            }
        }
    }

    static Result<Picture> drawPicture(View& view, const View::Input& input) {
        if (const auto drawn = view.draw(input); !drawn)
            return tl::unexpected<Error>(drawn.error());
        Result<Pixels> pixels = view.readPixels();
        if (!pixels)
            return tl::unexpected<Error>(std::move(pixels.error()));
        putUnder(input.options.background_srgb, pixels->rgba);
        return Picture{pixels->width, pixels->height, std::move(pixels->rgba)};
    }

    // camera: made for the first column, kept for the others.
    static Result<DrawnColumn> drawColumn(const Renderer& renderer,
                                          const RenderRequest& request,
                                          const ImageColumn& column,
                                          std::optional<OrbitCamera>& camera) {
        auto uploaded = upload(renderer, column);
        if (!uploaded)
            return tl::unexpected<Error>(uploaded.error());
        uploaded->scene.setMoment(request.moment);
        auto view = View::create(renderer);
        if (!view)
            return tl::unexpected<Error>(std::move(view.error()));
        if (!camera)
            camera = cameraFor(request, uploaded->scene.bounds());
        View::Input input;
        input.scene = &uploaded->scene;
        input.lod = &uploaded->lod;
        input.camera = *camera;
        input.options = shadedOptions(request.shading, *request.columns.front().scene);
        input.options.wireframe = request.wireframe;
        input.options.moment = request.moment;
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
            options.columns = sheetColumns(static_cast<std::uint32_t>(cells.size()));
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
