#pragma once
// Emits the JSON of a laid-out LOD. One template for writing and for counting bytes.
#include "scene/gltf/writer_layout.h"

#include <array>

namespace lodestone {

// Least and greatest value of each component of an accessor; zeros while only counting.
struct AccessorBounds {
    std::array<float, 16> min{};
    std::array<float, 16> max{};
};

template <class Sink>
class JsonEmitter {
public:
    // bounds: [layout.accessors], or empty when values do not matter.
    JsonEmitter(const ExportPlan& plan,
                const Layout& layout,
                std::span<const AccessorBounds> bounds,
                Sink& sink)
        : plan_(plan), layout_(layout), bounds_(bounds), sink_(sink) {}

    // buffer_uri: JSON text after the buffer's length, empty for .glb.
    void emit(std::string_view buffer_uri) {
        text("{");
        fragment(plan_.head);
        emitExtensionLists();
        emitAccessors();
        emitViews();
        if (layout_.binary_bytes > 0) {
            text(",\"buffers\":[{\"byteLength\":");
            number(layout_.binary_bytes);
            text(buffer_uri);
            text("}]");
        }
        emitMeshes();
        emitNodes();
        emitScenes();
        text("}");
    }

private:
    void text(std::string_view words) { sink_.text(words); }

    void number(std::uint64_t value) { sink_.number(value); }

    void fragment(const Fragment& part) { part.emit(sink_, layout_.node_index); }

    void emitNames(std::string_view key, const std::vector<std::string>& names, bool rows) {
        if (names.empty() && !rows)
            return;
        text(key);
        Separator comma(sink_);
        for (const std::string& name : names) {
            comma.next();
            text("\"");
            text(name);
            text("\"");
        }
        if (rows) {
            comma.next();
            text("\"EXT_mesh_gpu_instancing\"");
        }
        text("]");
    }

    void emitExtensionLists() {
        emitNames(",\"extensionsUsed\":[", plan_.extensions_used, layout_.uses_rows);
        emitNames(",\"extensionsRequired\":[", plan_.extensions_required, layout_.uses_rows);
    }

    void emitPlace(std::uint32_t view_class, std::uint64_t offset_bytes) {
        text("{\"bufferView\":");
        number(layout_.views[view_class].index);
        if (offset_bytes > 0) {
            text(",\"byteOffset\":");
            number(offset_bytes);
        }
    }

    void
    emitNumbers(std::string_view key, const StreamPlan& stream, std::span<const float> values) {
        text(key);
        for (std::uint32_t c = 0; c < stream.component_count; ++c) {
            if (c > 0)
                text(",");
            sink_.fixedNumber(values[c], stream.bounds_width);
        }
        text("]");
    }

    void emitAccessor(std::size_t index) {
        const AccessorLayout& accessor = layout_.accessors[index];
        emitPlace(accessor.view_class, accessor.offset_bytes);
        text(",\"count\":");
        number(accessor.count);
        text(",");
        if (accessor.stream == nullptr) {
            text(accessor.view_class == kIndex32Class
                     ? "\"componentType\":5125,\"type\":\"SCALAR\""
                     : "\"componentType\":5123,\"type\":\"SCALAR\"");
        } else {
            text(accessor.stream->format);
            if (accessor.stream->bounds_width > 0) {
                const AccessorBounds known = bounds_.empty() ? AccessorBounds{} : bounds_[index];
                emitNumbers(",\"max\":[", *accessor.stream, known.max);
                emitNumbers(",\"min\":[", *accessor.stream, known.min);
            }
        }
        text("}");
    }

    void emitGroupAccessors(std::size_t group, Separator<Sink>& comma) {
        const GroupLayout& to = layout_.groups[group];
        for (std::size_t a = 0; a < to.offset_bytes.size(); ++a) {
            comma.next();
            emitPlace(kInstanceClass, to.offset_bytes[a]);
            text(",\"count\":");
            number(to.rows);
            text(",");
            text(plan_.groups[group].stored(a, to.coarse).format);
            text("}");
        }
    }

    void emitAccessors() {
        if (plan_.carried.accessorCount() == 0 && layout_.accessors.empty() && !layout_.uses_rows)
            return;
        text(",\"accessors\":[");
        Separator comma(sink_);
        if (plan_.carried.accessorCount() > 0) {
            comma.next();
            text(plan_.carried.accessorsJson());
        }
        for (std::size_t a = 0; a < layout_.accessors.size(); ++a) {
            comma.next();
            emitAccessor(a);
        }
        for (std::size_t g = 0; g < layout_.groups.size(); ++g)
            emitGroupAccessors(g, comma);
        text("]");
    }

    void emitViews() {
        if (layout_.binary_bytes == 0)
            return;
        text(",\"bufferViews\":[");
        Separator comma(sink_);
        if (plan_.carried.viewCount() > 0) {
            comma.next();
            text(plan_.carried.viewsJson());
        }
        for (std::uint32_t c = 0; c < layout_.views.size(); ++c)
            if (layout_.views[c].size_bytes > 0) {
                comma.next();
                emitView(c);
            }
        text("]");
    }

    void emitView(std::uint32_t view_class) {
        const ViewLayout& view = layout_.views[view_class];
        text("{\"buffer\":0,\"byteLength\":");
        number(view.size_bytes);
        text(",\"byteOffset\":");
        number(view.offset_bytes);
        if (view_class >= kFirstStrideClass) {
            text(",\"byteStride\":");
            number(plan_.strides[view_class - kFirstStrideClass]);
            text(",\"target\":34962");
        } else if (view_class != kInstanceClass) {
            text(",\"target\":34963");
        }
        text("}");
    }

    void emitMeshes() {
        bool any = false;
        for (std::size_t m = 0; m < plan_.meshes.size(); ++m) {
            if (layout_.mesh_index[m] == kNone)
                continue;
            text(any ? "," : ",\"meshes\":[");
            any = true;
            if (plan_.meshes[m].submesh == kNone)
                text(plan_.meshes[m].whole);
            else
                emitMesh(plan_.meshes[m]);
        }
        if (any)
            text("]");
    }

    void emitMesh(const MeshPlan& mesh) {
        text("{\"primitives\":[");
        Separator comma(sink_);
        for (const PrimitivePlan& primitive : mesh.primitives)
            if (layout_.accessor_of[primitive.first_stream] != kNone) {
                comma.next();
                emitPrimitive(primitive);
            }
        text("]");
        if (!mesh.rest.empty()) {
            text(",");
            fragment(mesh.rest);
        }
        text("}");
    }

    void emitPrimitive(const PrimitivePlan& primitive) {
        text("{\"attributes\":{");
        std::uint32_t flat = primitive.first_stream;
        std::uint32_t target = kNone;
        bool first = true;
        for (const StreamPlan& stream : primitive.streams) {
            if (stream.target != target) {
                text(target == kNone ? "},\"targets\":[{" : "},{");
                target = stream.target;
                first = true;
            }
            if (!first)
                text(",");
            first = false;
            text(stream.key);
            number(layout_.accessor_of[flat++]);
        }
        text(target == kNone ? "}" : "}]");
        if (layout_.accessor_of[flat] != kNone) {
            text(",\"indices\":");
            number(layout_.accessor_of[flat]);
        }
        text(primitive.rest);
        text("}");
    }

    void emitNodes() {
        bool any = false;
        for (std::uint32_t n = 0; n < plan_.nodes.size(); ++n) {
            if (layout_.node_index[n] == kNone)
                continue;
            text(any ? "," : ",\"nodes\":[");
            any = true;
            emitNode(n);
        }
        if (any)
            text("]");
    }

    void emitNode(std::uint32_t n) {
        const NodePlan& node = plan_.nodes[n];
        text("{");
        Separator comma(sink_);
        if (!node.body.empty()) {
            comma.next();
            fragment(node.body);
        }
        if (layout_.draws[n]) {
            comma.next();
            text("\"mesh\":");
            number(layout_.mesh_index[node.mesh]);
            if (!node.with_mesh.empty()) {
                text(",");
                text(node.with_mesh);
            }
        }
        emitChildren(n, comma);
        const bool rows = node.group != kNone && layout_.groups[node.group].rows > 0;
        if (rows || !node.extensions.empty()) {
            comma.next();
            text("\"extensions\":{");
            fragment(node.extensions);
            if (rows)
                emitRows(node.group, !node.extensions.empty());
            text("}");
        }
        text("}");
    }

    void emitChildren(std::uint32_t n, Separator<Sink>& comma) {
        bool any = false;
        for (std::uint32_t c = plan_.first_child[n]; c < plan_.first_child[n + 1]; ++c) {
            const std::uint32_t index = layout_.node_index[plan_.children[c]];
            if (index == kNone)
                continue;
            if (!any)
                comma.next();
            text(any ? "," : "\"children\":[");
            any = true;
            number(index);
        }
        if (any)
            text("]");
    }

    void emitRows(std::uint32_t group, bool after_others) {
        text(after_others ? ",\"EXT_mesh_gpu_instancing\":{\"attributes\":{"
                          : "\"EXT_mesh_gpu_instancing\":{\"attributes\":{");
        Separator comma(sink_);
        std::uint32_t accessor = layout_.groups[group].first_accessor;
        for (const GroupAttribute& attribute : plan_.groups[group].attributes) {
            comma.next();
            text(attribute.key);
            number(accessor++);
        }
        text("}}");
    }

    void emitScenes() {
        text(",\"scenes\":[");
        Separator comma(sink_);
        for (const ScenePlan& scene : plan_.scenes) {
            comma.next();
            text("{");
            Separator members(sink_);
            if (!scene.rest.empty()) {
                members.next();
                fragment(scene.rest);
            }
            emitRoots(scene, members);
            text("}");
        }
        text("]");
    }

    void emitRoots(const ScenePlan& scene, Separator<Sink>& members) {
        bool any = false;
        for (const std::uint32_t root : scene.nodes) {
            if (layout_.node_index[root] == kNone)
                continue;
            if (!any)
                members.next();
            text(any ? "," : "\"nodes\":[");
            any = true;
            number(layout_.node_index[root]);
        }
        if (any)
            text("]");
    }

    const ExportPlan& plan_;
    const Layout& layout_;
    std::span<const AccessorBounds> bounds_;
    Sink& sink_;
};

} // namespace lodestone
