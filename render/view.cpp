#include "render/view.h"

#include "render/draw_pass.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>

namespace lodestone {

namespace {

using Clock = std::chrono::steady_clock;

double elapsedMs(Clock::time_point since) {
    return std::chrono::duration<double, std::milli>(Clock::now() - since).count();
}

// Everything a picture depends on.
struct PictureKey {
    const GpuSceneState* scene = nullptr;
    std::uint64_t scene_revision = 0;
    std::uint64_t lod_revision = 0;
    std::uint64_t marked_revision = 0; // of the LOD
    OrbitCamera camera;
    ViewOptions options;
    ViewSize size;

    bool operator==(const PictureKey&) const = default;
};

bool hasPicture(const View::Input& input) {
    return input.scene != nullptr && input.lod != nullptr && input.lod->valid();
}

PictureKey keyOf(const View::Input& input) {
    PictureKey key{nullptr, 0, 0, 0, input.camera, input.options, input.size};
    if (input.marked_lod != nullptr)
        key.marked_revision = input.marked_lod->revision();
    if (hasPicture(input)) {
        key.scene = &input.scene->state();
        key.scene_revision = input.scene->revision();
        key.lod_revision = input.lod->revision();
    }
    return key;
}

// llvmpipe spends 0.8 us a triangle on 4 x MSAA (1.4 s of 1.7 s for 1.8 M triangles), while drawing
// 2 x 2 as large costs 0.1 s at 640 x 480: from this count on the latter is cheaper.
constexpr std::uint64_t kSupersampledTriangles = 100'000;

constexpr double kShortestSliceMs = 2.0; // less time is left for the next call
constexpr std::uint64_t kEveryTriangle = std::numeric_limits<std::uint64_t>::max();

Antialiasing chooseAntialiasing(const View::Input& input, const GlInfo& info) {
    const int samples = std::clamp(input.options.samples, 1, std::max(info.max_samples, 1));
    const int largest = std::max(input.size.width_px, input.size.height_px);
    if (info.is_software && samples > 1 && hasPicture(input) &&
        input.lod->triangles() > kSupersampledTriangles && largest <= info.max_texture_size_px / 2)
        return {1, 2};
    return {samples, 1};
}

} // namespace

class ViewState {
public:
    explicit ViewState(std::shared_ptr<RendererState> renderer) : renderer_(std::move(renderer)) {}

    Result<DrawReport> draw(const View::Input& input, double budget_ms);
    Result<MeasureReport> measure(const View::Input& input, const MeasureOptions& options);
    Result<Pixels> readPixels() const;

    void invalidate() {
        key_.reset();
        sliced_.reset();
    }

    GLuint texture() const { return color_.name(); }

    ViewSize size() const { return size_; }

private:
    Result<void> resize(ViewSize size, Antialiasing antialiasing);
    Result<void> makeDrawnBuffer();
    Result<DrawTotals> render(const View::Input& input);
    void beginPicture(const View::Input& input);
    Result<DrawTotals> drawSlices(const View::Input& input, DrawCursor& cursor, double budget_ms);
    void endPicture(const View::Input& input);
    Result<DrawReport>
    drawBudgeted(const View::Input& input, const PictureKey& key, double budget_ms);
    void beginTimer();
    void endTimer();
    void collectTimers();

    std::shared_ptr<RendererState> renderer_;
    ViewSize size_{0, 0};
    Antialiasing antialiasing_;
    GlTexture color_;        // resolved picture
    GlFramebuffer resolved_; // color_
    GlFramebuffer drawn_;    // what is drawn into, then scaled or resolved into color_
    GlRenderbuffer drawn_color_;
    GlRenderbuffer drawn_depth_;
    Culling culling_;
    std::optional<PictureKey> key_;
    DrawReport last_;

    struct Sliced { // a picture that is drawn over several calls
        PictureKey key;
        DrawCursor cursor;
        DrawTotals totals;
        double cost_ms = 0.0;
    };

    std::optional<Sliced> sliced_;
    bool transparent_ = false;

    struct Timer {
        GlQuery query;
        bool pending = false;
    };

    std::array<Timer, 3> timers_;
    std::size_t timer_ = 0;
    Clock::time_point started_;
};

Result<void> ViewState::resize(ViewSize size, Antialiasing antialiasing) {
    if (size == size_ && antialiasing == antialiasing_)
        return {};
    const int limit = renderer_->info().max_texture_size_px;
    if (size.width_px < 1 || size.height_px < 1 || size.width_px > limit || size.height_px > limit)
        return fail(ErrorKind::Usage,
                    "a view of " + std::to_string(size.width_px) + " x " +
                        std::to_string(size.height_px) + " px cannot be drawn; use 1 to " +
                        std::to_string(limit) + " px a side");
    if (!(size == size_)) {
        color_ = GlTexture::create();
        glBindTexture(GL_TEXTURE_2D, color_.name());
        glTexImage2D(GL_TEXTURE_2D,
                     0,
                     GL_RGBA8,
                     size.width_px,
                     size.height_px,
                     0,
                     GL_RGBA,
                     GL_UNSIGNED_BYTE,
                     nullptr);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
        glBindTexture(GL_TEXTURE_2D, 0);
        resolved_ = GlFramebuffer::create();
        glBindFramebuffer(GL_FRAMEBUFFER, resolved_.name());
        glFramebufferTexture2D(
            GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color_.name(), 0);
    }
    size_ = size;
    antialiasing_ = antialiasing;
    return makeDrawnBuffer();
}

Result<void> ViewState::makeDrawnBuffer() {
    const int width = size_.width_px * antialiasing_.scale;
    const int height = size_.height_px * antialiasing_.scale;
    const GLsizei samples = antialiasing_.samples > 1 ? antialiasing_.samples : 0;
    drawn_color_ = GlRenderbuffer::create();
    glBindRenderbuffer(GL_RENDERBUFFER, drawn_color_.name());
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, width, height);
    drawn_depth_ = GlRenderbuffer::create();
    glBindRenderbuffer(GL_RENDERBUFFER, drawn_depth_.name());
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH_COMPONENT24, width, height);
    drawn_ = GlFramebuffer::create();
    glBindFramebuffer(GL_FRAMEBUFFER, drawn_.name());
    glFramebufferRenderbuffer(
        GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, drawn_color_.name());
    glFramebufferRenderbuffer(
        GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, drawn_depth_.name());
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (status == GL_FRAMEBUFFER_COMPLETE)
        return {};
    const std::string size =
        std::to_string(size_.width_px) + " x " + std::to_string(size_.height_px);
    size_ = {0, 0};
    return fail(ErrorKind::Failed, "the GPU refuses a view of " + size + " px; use a smaller one");
}

void ViewState::beginPicture(const View::Input& input) {
    glBindFramebuffer(GL_FRAMEBUFFER, drawn_.name());
    glViewport(0, 0, size_.width_px * antialiasing_.scale, size_.height_px * antialiasing_.scale);
    glDisable(GL_SCISSOR_TEST);
    drawBackground(*renderer_, input.options);
}

Result<DrawTotals> ViewState::render(const View::Input& input) {
    beginPicture(input);
    Result<DrawTotals> totals;
    DrawCursor cursor;
    cursor.culling = &culling_;
    if (hasPicture(input)) {
        culling_.prepare(input);
        totals = drawLod(input, antialiasing_, cursor, kEveryTriangle);
        if (totals && !cursor.complete)
            if (const auto over = drawOver(input, antialiasing_, cursor, kEveryTriangle); !over)
                totals = tl::unexpected(over.error());
    }
    endPicture(input);
    return totals;
}

// At least one slice; stops once the budget is as good as spent or everything is drawn. The pace is
// that of surfaces alone.
Result<DrawTotals>
ViewState::drawSlices(const View::Input& input, DrawCursor& cursor, double budget_ms) {
    const Clock::time_point begun = Clock::now();
    glBindFramebuffer(GL_FRAMEBUFFER, drawn_.name());
    glViewport(0, 0, size_.width_px * antialiasing_.scale, size_.height_px * antialiasing_.scale);
    SlicePace& pace = renderer_->slicePace();
    DrawTotals all;
    double spent_ms = 0.0;
    do {
        const std::uint64_t most = pace.trianglesWithin(budget_ms - spent_ms);
        std::uint64_t surfaces = 0;
        if (cursor.finished) {
            if (const auto over = drawOver(input, antialiasing_, cursor, most); !over)
                return tl::unexpected(over.error());
        } else {
            const Result<DrawTotals> slice = drawLod(input, antialiasing_, cursor, most);
            if (!slice)
                return tl::unexpected(slice.error());
            surfaces = slice->triangles;
            all.triangles += slice->triangles;
            all.draw_calls += slice->draw_calls;
        }
        glFinish();
        const double now_ms = elapsedMs(begun);
        pace.drew(surfaces, now_ms - spent_ms);
        spent_ms = now_ms;
    } while (!cursor.complete && spent_ms + kShortestSliceMs < budget_ms);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return all;
}

void ViewState::endPicture(const View::Input& input) {
    const int width = size_.width_px * antialiasing_.scale;
    const int height = size_.height_px * antialiasing_.scale;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, drawn_.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_.name());
    // Halving with the linear filter averages exactly four pixels.
    glBlitFramebuffer(0,
                      0,
                      width,
                      height,
                      0,
                      0,
                      size_.width_px,
                      size_.height_px,
                      GL_COLOR_BUFFER_BIT,
                      antialiasing_.scale > 1 ? GL_LINEAR : GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    transparent_ = input.options.background == Background::Transparent;
}

void ViewState::beginTimer() {
    if (renderer_->info().is_software) {
        glFinish(); // what others queued is not this view's cost
        started_ = Clock::now();
        return;
    }
    timer_ = (timer_ + 1) % timers_.size();
    Timer& timer = timers_[timer_];
    if (!timer.query)
        timer.query = GlQuery::create();
    glBeginQuery(GL_TIME_ELAPSED, timer.query.name());
}

void ViewState::endTimer() {
    if (renderer_->info().is_software) {
        glFinish();
        last_.cost_ms = elapsedMs(started_);
        last_.cost_known = true;
        return;
    }
    glEndQuery(GL_TIME_ELAPSED);
    timers_[timer_].pending = true;
}

void ViewState::collectTimers() {
    for (std::size_t i = 1; i <= timers_.size(); ++i) { // oldest first
        Timer& timer = timers_[(timer_ + i) % timers_.size()];
        if (!timer.pending)
            continue;
        GLint available = GL_FALSE;
        glGetQueryObjectiv(timer.query.name(), GL_QUERY_RESULT_AVAILABLE, &available);
        if (available != GL_TRUE)
            continue;
        GLuint64 elapsed_ns = 0;
        glGetQueryObjectui64v(timer.query.name(), GL_QUERY_RESULT, &elapsed_ns);
        timer.pending = false;
        last_.cost_ms = static_cast<double>(elapsed_ns) * 1e-6;
        last_.cost_known = true;
    }
}

Result<DrawReport>
ViewState::drawBudgeted(const View::Input& input, const PictureKey& key, double budget_ms) {
    const Clock::time_point begun = Clock::now();
    if (!sliced_ || !(sliced_->key == key)) {
        sliced_.reset();
        const bool first = !color_;
        if (Result<void> resized = resize(input.size, chooseAntialiasing(input, renderer_->info()));
            !resized)
            return tl::unexpected(resized.error());
        beginPicture(input);
        if (first)
            endPicture(input);
        sliced_ = Sliced{key, {}, {}, 0.0};
        sliced_->cursor.culling = &culling_;
        culling_.prepare(input);
    }
    const Result<DrawTotals> totals = drawSlices(input, sliced_->cursor, budget_ms);
    if (!totals) {
        sliced_.reset();
        return tl::unexpected(totals.error());
    }
    sliced_->totals.triangles += totals->triangles;
    sliced_->totals.draw_calls += totals->draw_calls;
    last_.complete = sliced_->cursor.complete;
    if (!last_.complete) {
        sliced_->cost_ms += elapsedMs(begun);
        return last_;
    }
    endPicture(input);
    glFinish();
    last_.drew = true;
    last_.cost_ms = sliced_->cost_ms + elapsedMs(begun);
    last_.cost_known = true;
    last_.triangles = sliced_->totals.triangles;
    last_.draw_calls = sliced_->totals.draw_calls;
    key_ = sliced_->key;
    sliced_.reset();
    return last_;
}

Result<DrawReport> ViewState::draw(const View::Input& input, double budget_ms) {
    collectTimers();
    const PictureKey key = keyOf(input);
    last_.drew = false;
    last_.complete = true;
    if (key_ && *key_ == key)
        return last_;
    key_.reset();
    if (renderer_->info().is_software && budget_ms < View::kNoBudget && hasPicture(input))
        return drawBudgeted(input, key, budget_ms);
    sliced_.reset();
    if (Result<void> resized = resize(input.size, chooseAntialiasing(input, renderer_->info()));
        !resized)
        return tl::unexpected(resized.error());
    beginTimer();
    const Result<DrawTotals> totals = render(input);
    endTimer();
    if (!totals)
        return tl::unexpected(totals.error());
    key_ = key;
    last_.drew = true;
    last_.triangles = totals->triangles;
    last_.draw_calls = totals->draw_calls;
    return last_;
}

Result<MeasureReport> ViewState::measure(const View::Input& input, const MeasureOptions& options) {
    const Result<DrawReport> first = draw(input, View::kNoBudget); // unless that is the picture
    if (!first)
        return tl::unexpected(first.error());
    const Clock::time_point begun = Clock::now();
    const double budget_ms = options.budget_s * 1000.0;
    const auto spent = [&] { return budget_ms > 0.0 && elapsedMs(begun) >= budget_ms; };
    const auto frame = [&]() -> Result<void> {
        const Result<DrawTotals> totals = render(input);
        if (!totals)
            return tl::unexpected(totals.error());
        glFinish();
        return {};
    };
    for (int i = 0; i < options.warmup_frames && !spent(); ++i)
        if (Result<void> drawn = frame(); !drawn)
            return tl::unexpected(drawn.error());
    MeasureReport report;
    const Clock::time_point counted = Clock::now();
    do {
        if (Result<void> drawn = frame(); !drawn)
            return tl::unexpected(drawn.error());
        ++report.frames;
    } while (static_cast<std::int64_t>(report.frames) < options.frames && !spent());
    report.mean_ms = elapsedMs(counted) / static_cast<double>(report.frames);
    report.fps = report.mean_ms > 0.0 ? 1000.0 / report.mean_ms : 0.0;
    return report;
}

Result<Pixels> ViewState::readPixels() const {
    if (!color_ || size_.width_px < 1)
        return fail(ErrorKind::Failed, "nothing was drawn yet");
    const auto width = static_cast<std::uint32_t>(size_.width_px);
    const auto height = static_cast<std::uint32_t>(size_.height_px);
    std::vector<std::uint8_t> rows(std::size_t(4) * width * height);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved_.name());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, size_.width_px, size_.height_px, GL_RGBA, GL_UNSIGNED_BYTE, rows.data());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    Pixels pixels;
    pixels.width = width;
    pixels.height = height;
    pixels.rgba.resize(rows.size());
    const std::size_t stride = std::size_t(4) * width;
    for (std::size_t y = 0; y < height; ++y)
        std::copy_n(&rows[(height - 1 - y) * stride], stride, &pixels.rgba[y * stride]);
    for (std::size_t i = 0; i < pixels.rgba.size(); i += 4) {
        const int alpha = transparent_ ? pixels.rgba[i + 3] : 255;
        pixels.rgba[i + 3] = static_cast<std::uint8_t>(alpha);
        if (alpha == 0 || alpha == 255)
            continue;
        for (std::size_t c = 0; c < 3; ++c) // the GPU holds premultiplied colour
            pixels.rgba[i + c] = static_cast<std::uint8_t>(
                std::min(255, (pixels.rgba[i + c] * 255 + alpha / 2) / alpha));
    }
    return pixels;
}

View::View(std::unique_ptr<ViewState> state) : state_(std::move(state)) {}

View::View(View&&) noexcept = default;
View& View::operator=(View&&) noexcept = default;
View::~View() = default;

Result<View> View::create(const Renderer& renderer) {
    return View(std::make_unique<ViewState>(renderer.shared()));
}

Result<DrawReport> View::draw(const Input& input, double budget_ms) {
    return state_->draw(input, budget_ms);
}

void View::invalidate() {
    state_->invalidate();
}

TextureHandle View::texture() const {
    return state_->texture();
}

ViewSize View::size() const {
    return state_->size();
}

Result<Pixels> View::readPixels() const {
    return state_->readPixels();
}

Result<MeasureReport> View::measure(const Input& input, const MeasureOptions& options) {
    return state_->measure(input, options);
}

} // namespace lodestone
