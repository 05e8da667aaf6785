#include "render/draw_pass.h"

#include "render/frame_block.h"
#include "render/lod_state.h"
#include "render/transparency.h"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <utility>

namespace lodestone {

namespace {

std::uint32_t shadeFeature(Shading shading) {
    switch (shading) {
    case Shading::Clay:
        return kShadeClay;
    case Shading::Normals:
        return kShadeNormals;
    case Shading::Flat:
        return kShadeBaseColor | kFacets;
    case Shading::UvChecker:
        return kShadeUv;
    case Shading::BySubmesh:
        return kShadeSubmesh;
    case Shading::ByInstance:
        return kByInstance;
    case Shading::Matcap:
        return kShadeMatcap;
    case Shading::ByLodState:
        return kShadeSubmesh;
    case Shading::ByTexels:
        return kShadeValue | kShadeUv;
    case Shading::ByValue:
        return kShadeValue;
    case Shading::Lit:
        break;
    }
    return kShadeLit;
}

// The features a draw needs and no more: few programs, lean vertex shaders.
std::uint32_t itemFeatures(const DrawItem& item, const GpuSceneState& scene, Shading shading) {
    const GpuMaterial& material = scene.materials[item.material];
    std::uint32_t features = shadeFeature(shading) | material.features;
    const bool shows_base = shading == Shading::Lit || shading == Shading::Flat;
    if (!shows_base)
        features &= ~(kAlphaBlend | kUnlit);
    if (shading == Shading::Flat)
        features &= ~kUnlit;
    const bool uses_alpha = (features & (kAlphaMask | kAlphaBlend)) != 0;
    if (!shows_base && !uses_alpha && shading != Shading::ByTexels)
        features &= ~kBaseMap;
    if (shading != Shading::Lit || (features & kUnlit) != 0)
        features &= ~(kAnyMap & ~kBaseMap);

    const std::uint32_t layout = item.geometry->layout.features;
    if (item.mode != PrimitiveMode::Triangles)
        features |= kNoSurface;
    const bool smooth = (features & (kNoSurface | kFacets)) == 0 &&
                        !(shading == Shading::Lit && (features & kUnlit) != 0);
    if (smooth)
        features |= layout & kHasNormal;
    if (shows_base || uses_alpha)
        features |= layout & kHasColor;
    if ((features & kAnyMap) != 0)
        features |= layout & (kHasUv0 | kHasUv1);
    if (shading == Shading::UvChecker)
        features |= layout & kHasUv0;
    if (shading == Shading::ByValue)
        features |= layout & kHasValue;
    if ((features & (kHasUv0 | kHasUv1)) == 0)
        features &= ~kAnyMap;
    if (scene.pose.submeshes[item.submesh].posed)
        features |= kPosed | (layout & (kHasJoints | kHasMoreJoints));
    if (scene.pose.submeshes[item.submesh].morphed)
        features |= layout & kMorphed;
    if ((features & kNormalMap) != 0 && (features & kHasNormal) != 0)
        features |= layout & kHasTangent;
    if (scene.mirroring(item.submesh) == Mirroring::Mixed && item.mode == PrimitiveMode::Triangles)
        features |= kMixedMirror;
    return features;
}

GLenum glMode(PrimitiveMode mode) {
    switch (mode) {
    case PrimitiveMode::Points:
        return GL_POINTS;
    case PrimitiveMode::Lines:
        return GL_LINES;
    case PrimitiveMode::LineLoop:
        return GL_LINE_LOOP;
    case PrimitiveMode::LineStrip:
        return GL_LINE_STRIP;
    case PrimitiveMode::Triangles:
        break;
    }
    return GL_TRIANGLES;
}

void setEnabled(GLenum capability, bool enabled) {
    if (enabled)
        glEnable(capability);
    else
        glDisable(capability);
}

// Binds what changes from item to item, skipping what is bound already.
class ItemBinder {
public:
    ItemBinder(const GpuSceneState& scene, const ViewOptions& options, int samples)
        : scene_(scene), options_(options), samples_(samples) {}

    // over: what is added to the features that the shading asks for.
    Result<void> bind(const DrawItem& item, std::uint32_t over = 0) {
        const Shading shading = over == kHighlight ? Shading::Clay : options_.shading;
        std::uint32_t features = itemFeatures(item, scene_, shading) | over;
        if (options_.wireframe && over == 0 && item.mode == PrimitiveMode::Triangles)
            features |= kWireframe;
        if (!program_ || features != features_) {
            Result<const SceneProgram*> program = scene_.renderer->sceneProgram(features);
            if (!program)
                return tl::unexpected(program.error());
            program_ = *program;
            features_ = features;
            glUseProgram(program_->program.name());
            bindCoverage();
        }
        if (item.material != material_) {
            material_ = item.material;
            bindMaterial();
        }
        bindFacing(item);
        bindPose(item);
        if (program_->submesh_color >= 0)
            glUniform4fv(program_->submesh_color, 1, glm::value_ptr(submeshColor(item)));
        glBindVertexArray(item.vertex_array.name());
        return {};
    }

private:
    glm::vec4 submeshColor(const DrawItem& item) const {
        return options_.shading == Shading::ByLodState
                   ? lodStateColor(item, *scene_.scene, options_)
                   : scene_.submeshes[item.submesh].id_color;
    }

    void bindCoverage() const {
        const bool covers = (features_ & (kAlphaMask | kHighlight)) == kAlphaMask && samples_ > 1;
        setEnabled(GL_SAMPLE_ALPHA_TO_COVERAGE, covers);
        setEnabled(GL_SAMPLE_ALPHA_TO_ONE, covers);
        const bool blends = (features_ & (kAlphaBlend | kHighlight)) != 0;
        setEnabled(GL_BLEND, blends);
        glDepthMask(blends ? GL_FALSE : GL_TRUE);
    }

    void bindMaterial() const {
        const GpuMaterial& material = scene_.materials[material_];
        glBindBufferRange(GL_UNIFORM_BUFFER,
                          kMaterialBinding,
                          scene_.material_blocks.name(),
                          material.block_offset,
                          sizeof(MaterialBlock));
        for (GLuint unit = 0; unit < kMaterialMaps; ++unit) {
            const MaterialMap& map = material.maps[unit];
            glActiveTexture(GL_TEXTURE0 + unit);
            glBindTexture(GL_TEXTURE_2D,
                          map.texture != 0 ? map.texture : scene_.renderer->whiteTexture());
            glBindSampler(unit, map.sampler);
        }
    }

    void bindPose(const DrawItem& item) const {
        if ((features_ & (kPosed | kMorphed)) == 0)
            return;
        const GpuGeometry& geometry = *item.geometry;
        glActiveTexture(GL_TEXTURE0 + kPoseUnit);
        glBindTexture(GL_TEXTURE_BUFFER, scene_.pose_texture.name());
        glActiveTexture(GL_TEXTURE0 + kMorphUnit);
        glBindTexture(GL_TEXTURE_BUFFER, geometry.morph_texture.name());
        glUniform1i(program_->pose_row, scene_.pose.submeshes[item.submesh].first_row);
        glUniform2i(program_->morph_shape,
                    static_cast<GLint>(geometry.morph_targets),
                    static_cast<GLint>(geometry.vertex_count));
    }

    void bindFacing(const DrawItem& item) const {
        const Mirroring mirroring = scene_.mirroring(item.submesh);
        const bool culls = options_.back_faces == BackFaces::PerMaterial &&
                           !scene_.materials[item.material].double_sided;
        const bool is_mixed = mirroring == Mirroring::Mixed;
        setEnabled(GL_CULL_FACE, culls && !is_mixed);
        glFrontFace(mirroring == Mirroring::All ? GL_CW : GL_CCW);
        if (program_->cull_back >= 0)
            glUniform1f(program_->cull_back, culls && is_mixed ? 1.0f : 0.0f);
    }

    const GpuSceneState& scene_;
    const ViewOptions& options_;
    int samples_ = 1;
    const SceneProgram* program_ = nullptr;
    std::uint32_t features_ = 0;
    std::uint32_t material_ = kNone;
};

// A part of an item: some of its instances, or some of its one instance's indices.
struct DrawRange {
    std::uint32_t index_begin = 0;
    std::uint32_t index_count = 0;
    std::uint32_t instance_count = 0;
};

std::uint64_t triangleCount(const DrawItem& item, const DrawRange& range) {
    const bool triangles = item.mode == PrimitiveMode::Triangles;
    return triangles ? std::uint64_t(range.index_count / 3) * range.instance_count : 0;
}

// What follows `begin` (see DrawCursor), about most_triangles of it and not nothing.
DrawRange nextRange(const DrawItem& item,
                    std::uint32_t instance_count,
                    std::uint32_t begin,
                    std::uint64_t most_triangles) {
    DrawRange range{0, item.geometry->index_count, instance_count};
    if (item.mode != PrimitiveMode::Triangles || range.index_count < 3)
        return range;
    if (instance_count > 1) {
        const std::uint64_t most = most_triangles / (range.index_count / 3) + 1;
        const std::uint64_t left = instance_count - begin;
        range.instance_count = static_cast<std::uint32_t>(std::min(left, most));
    } else {
        const std::uint64_t left = range.index_count - begin;
        const std::uint64_t most = std::min(most_triangles, left) + 1;
        range.index_begin = begin;
        range.index_count = static_cast<std::uint32_t>(std::min(left, most * 3));
    }
    return range;
}

// Behind the range; back at 0 once the item is finished.
std::uint32_t placeBehind(const DrawItem& item,
                          std::uint32_t instance_count,
                          std::uint32_t begin,
                          const DrawRange& range) {
    const bool by_instance = instance_count > 1;
    const std::uint32_t end = begin + (by_instance ? range.instance_count : range.index_count);
    return end >= (by_instance ? instance_count : item.geometry->index_count) ? 0 : end;
}

void drawItem(const DrawItem& item, const DrawRange& range) {
    const auto instances = static_cast<GLsizei>(range.instance_count);
    const GLenum mode = glMode(item.mode);
    const std::uintptr_t index_size = item.geometry->index_type == GL_UNSIGNED_SHORT ? 2 : 4;
    if (item.geometry->index_count > 0)
        glDrawElementsInstanced(
            mode,
            static_cast<GLsizei>(range.index_count),
            item.geometry->index_type,
            reinterpret_cast<const void*>(range.index_begin * index_size), // NOLINT: GL wants it so
            instances);
    else
        glDrawArraysInstanced(
            mode, 0, static_cast<GLsizei>(item.geometry->vertex_count), instances);
}

void setFixedState() {
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_STENCIL_TEST);
    glEnable(GL_MULTISAMPLE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_TRUE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glCullFace(GL_BACK);
    glPointSize(4.0f);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
}

void resetState() {
    glBindVertexArray(0);
    glUseProgram(0);
    glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    glDisable(GL_SAMPLE_ALPHA_TO_ONE);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glDisable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glFrontFace(GL_CCW);
    for (GLuint unit = 0; unit < kMaterialMaps; ++unit) {
        glBindSampler(unit, 0);
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_2D, 0);
    }
    for (const GLuint unit : {kPoseUnit, kMorphUnit}) {
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_BUFFER, 0);
    }
    glActiveTexture(GL_TEXTURE0);
}

// Draws items, counting.
class ItemDrawer {
public:
    ItemDrawer(const View::Input& input, const Antialiasing& antialiasing)
        : input_(input), scene_(input.scene->state()),
          binder_(scene_, input.options, antialiasing.samples) {}

    Result<void> drawFrom(DrawCursor& cursor, std::uint64_t most_triangles) {
        const std::vector<DrawItem>& items = input_.lod->state()->items;
        const std::vector<BlendedInstance> sorted = backToFront(input_);
        while (cursor.item < items.size()) {
            const DrawItem& item = items[cursor.item];
            if (isSkipped(item, !sorted.empty())) {
                ++cursor.item;
                continue;
            }
            if (totals_.triangles >= most_triangles)
                return {};
            const SeenInstances seen =
                cursor.culling ? cursor.culling->seen(cursor.item, input_)
                               : SeenInstances{item.instances.get(), item.kept_instances};
            if (seen.count == 0) {
                ++cursor.item;
                continue;
            }
            const DrawRange range =
                nextRange(item, seen.count, cursor.begin, most_triangles - totals_.triangles);
            if (Result<void> drawn = drawPart(item, seen, cursor.begin, range); !drawn)
                return drawn;
            cursor.begin = placeBehind(item, seen.count, cursor.begin, range);
            if (cursor.begin == 0)
                ++cursor.item;
        }
        cursor.finished = true;
        cursor.complete = input_.options.highlighted.empty() && !input_.options.grid;
        return drawSorted(sorted);
    }

    // Over the surfaces that are there already. Returns whether all are drawn.
    Result<bool> drawHighlightedFrom(DrawCursor& cursor, std::uint64_t most_triangles) {
        const std::vector<DrawItem>& items = input_.lod->state()->items;
        const std::vector<Highlight>& highlighted = input_.options.highlighted;
        while (cursor.mark < highlighted.size() * items.size()) {
            const Highlight& highlight = highlighted[cursor.mark / items.size()];
            const DrawItem& item = items[cursor.mark % items.size()];
            if (item.submesh == highlight.submesh && item.mode == PrimitiveMode::Triangles) {
                if (totals_.triangles >= most_triangles)
                    return false;
                const std::uint64_t most = most_triangles - totals_.triangles;
                if (const Result<void> drawn =
                        drawHighlighted(item, highlight.instance, cursor.mark_begin, most);
                    !drawn)
                    return tl::unexpected(drawn.error());
            }
            if (cursor.mark_begin == 0)
                ++cursor.mark;
        }
        return true;
    }

    void drawGrid() const {
        glUseProgram(scene_.renderer->gridProgram().name());
        glDisable(GL_CULL_FACE);
        glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
        glDisable(GL_SAMPLE_ALPHA_TO_ONE);
        glEnable(GL_BLEND);
        glDepthMask(GL_FALSE);
        glEnable(GL_DEPTH_CLAMP); // it reaches beyond the planes that enclose the scene
        glBindVertexArray(scene_.renderer->emptyVertexArray());
        glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
        glDisable(GL_DEPTH_CLAMP);
    }

    const DrawTotals& totals() const { return totals_; }

private:
    bool isSkipped(const DrawItem& item, bool blended_are_sorted) const {
        return (!scene_.hidden.empty() && scene_.hidden[item.submesh]) ||
               (blended_are_sorted && isBlended(item, scene_, input_.options.shading));
    }

    Result<void> draw(const DrawItem& item, const DrawRange& range) {
        if (Result<void> bound = binder_.bind(item); !bound)
            return bound;
        drawItem(item, range);
        ++totals_.draw_calls;
        totals_.triangles += triangleCount(item, range);
        return {};
    }

    Result<void> drawPart(const DrawItem& item,
                          const SeenInstances& seen,
                          std::uint32_t begin,
                          const DrawRange& range) {
        const std::uint32_t first = seen.count > 1 ? begin : 0;
        if (first == 0 && seen.buffer == item.instances.get())
            return draw(item, range);
        return drawInstances(item, *seen.buffer, first, range);
    }

    Result<void> drawInstances(const DrawItem& item,
                               const InstanceBuffer& instances,
                               std::uint32_t first,
                               const DrawRange& range) {
        glBindVertexArray(item.vertex_array.name());
        pointAtInstances(instances, first);
        Result<void> drawn = draw(item, range);
        pointAtInstances(*item.instances, 0);
        return drawn;
    }

    Result<void> drawSorted(const std::vector<BlendedInstance>& sorted) {
        for (const BlendedInstance& blended : sorted) {
            const DrawRange one{0, blended.item->geometry->index_count, 1};
            if (Result<void> drawn =
                    drawInstances(*blended.item, *blended.item->instances, blended.place, one);
                !drawn)
                return drawn;
        }
        return {};
    }

    // One instance or, with kNone, all from `begin` on, which moves behind what is drawn and is 0
    // again once all are.
    Result<void> drawHighlighted(const DrawItem& item,
                                 std::uint32_t instance,
                                 std::uint32_t& begin,
                                 std::uint64_t most_triangles) {
        DrawRange range{0, item.geometry->index_count, 1};
        std::uint32_t place = 0;
        if (instance != kNone) {
            place = placeOf(item, instance);
            if (place == kNone)
                return {};
        } else {
            const std::uint32_t count = item.kept_instances;
            if (count == 0)
                return {};
            range = nextRange(item, count, begin, most_triangles);
            place = count > 1 ? begin : 0;
            begin = placeBehind(item, count, begin, range);
        }
        if (Result<void> bound = binder_.bind(item, kHighlight); !bound)
            return bound;
        pointAtInstances(*item.instances, place);
        drawItem(item, range);
        pointAtInstances(*item.instances, 0);
        totals_.triangles += triangleCount(item, range);
        return {};
    }

    // Of an instance among those that are kept; kNone: it is not.
    std::uint32_t placeOf(const DrawItem& item, std::uint32_t instance) const {
        const std::uint32_t begin = scene_.submeshes[item.submesh].range.begin;
        std::uint32_t place = instance - begin;
        if (const auto& order = item.instances->order)
            place =
                static_cast<std::uint32_t>(std::ranges::find(*order, instance) - order->begin());
        else if (instance < begin)
            return kNone;
        return place < item.kept_instances ? place : kNone;
    }

    const View::Input& input_;
    const GpuSceneState& scene_;
    ItemBinder binder_;
    DrawTotals totals_;
};

void useFrame(const RendererState& renderer, const FrameBlock& block) {
    glBindBuffer(GL_UNIFORM_BUFFER, renderer.frameBuffer());
    glBufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_STREAM_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, kFrameBinding, renderer.frameBuffer());
}

} // namespace

void drawBackground(const RendererState& renderer, const ViewOptions& options) {
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
    const glm::vec3 color = options.background_srgb;
    if (options.background == Background::Transparent)
        glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    else
        glClearColor(color.r, color.g, color.b, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    if (options.background != Background::Gradient)
        return;
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glUseProgram(renderer.backgroundProgram().name());
    const glm::vec3 lower = color * 0.82f;
    const glm::vec3 upper = glm::min(color * 1.22f, glm::vec3(1.0f));
    glUniform3fv(renderer.backgroundLower(), 1, glm::value_ptr(lower));
    glUniform3fv(renderer.backgroundUpper(), 1, glm::value_ptr(upper));
    glBindVertexArray(renderer.emptyVertexArray());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
}

Result<DrawTotals> drawLod(const View::Input& input,
                           const Antialiasing& antialiasing,
                           DrawCursor& cursor,
                           std::uint64_t most_triangles) {
    const GpuSceneState& scene = input.scene->state();
    setFixedState();
    useFrame(*scene.renderer, frameBlock(input, antialiasing));
    ItemDrawer drawer(input, antialiasing);
    const Result<void> drawn = drawer.drawFrom(cursor, most_triangles);
    resetState();
    if (!drawn)
        return tl::unexpected(drawn.error());
    return drawer.totals();
}

Result<void> drawOver(const View::Input& input,
                      const Antialiasing& antialiasing,
                      DrawCursor& cursor,
                      std::uint64_t most_triangles) {
    const RendererState& renderer = *input.scene->state().renderer;
    View::Input marks = input;
    if (input.marked_scene != nullptr) { // what is highlighted lies in another scene
        marks.scene = input.marked_scene;
        marks.lod = input.marked_lod;
        useFrame(renderer, nearerFrameBlock(marks, antialiasing));
    } else {
        useFrame(renderer, frameBlock(input, antialiasing));
    }
    setFixedState();
    const Result<bool> all =
        ItemDrawer(marks, antialiasing).drawHighlightedFrom(cursor, most_triangles);
    if (all && *all && input.options.grid) {
        useFrame(renderer, frameBlock(input, antialiasing));
        ItemDrawer(input, antialiasing).drawGrid();
    }
    resetState();
    if (!all)
        return tl::unexpected(all.error());
    cursor.complete = *all;
    return {};
}

} // namespace lodestone
