#include "scene/gltf/writer_meshes.h"

#include "scene/gltf/writer_references.h"
#include "scene/gltf/writer_uri.h"

#include <algorithm>
#include <cstring>
#include <tuple>

namespace lodestone {

using nlohmann::json;

namespace {

constexpr std::uint32_t kPositions = kNone; // StreamPlan::attribute

// Numbers the contents of streams: one number for streams that the file stores once and whose bytes
// are still equal. Equal bytes that the file stores twice stay two, so that simplifying one of them
// never makes the export larger.
class ContentNumbers {
public:
    // accessor: of the file, kNone if the stream is in no file; then it shares nothing.
    // kind: streams of different kinds never share an accessor.
    std::uint32_t
    numberOf(std::uint32_t accessor, const std::string& kind, std::span<const std::byte> bytes) {
        if (accessor == kNone)
            return next_++;
        std::vector<Known>& candidates = known_[{accessor, kind}];
        for (const Known& known : candidates)
            if (std::ranges::equal(known.bytes, bytes))
                return known.number;
        candidates.push_back({bytes, next_});
        return next_++;
    }

    std::uint32_t count() const { return next_; }

private:
    struct Known {
        std::span<const std::byte> bytes;
        std::uint32_t number = 0;
    };

    std::map<std::pair<std::uint32_t, std::string>, std::vector<Known>> known_;
    std::uint32_t next_ = 0;
};

// The number of what a member of `owner` refers to; kNone if there is none.
std::uint32_t numberAt(const json& owner, const std::string& key) {
    const auto found = owner.is_object() ? owner.find(key) : owner.end();
    return owner.is_object() && found != owner.end() && found->is_number_unsigned()
               ? found->get<std::uint32_t>()
               : kNone;
}

const json& memberOrNull(const json& owner, const char* key) {
    static const json null;
    const auto found = owner.is_object() ? owner.find(key) : owner.end();
    return owner.is_object() && found != owner.end() ? *found : null;
}

std::string accessorType(std::uint32_t components) {
    switch (components) {
    case 1:
        return "SCALAR";
    case 9:
        return "MAT3";
    case 16:
        return "MAT4";
    default:
        return "VEC" + std::to_string(components);
    }
}

std::string formatOf(const StoredType& stored, std::uint32_t components) {
    json format{{"componentType", static_cast<int>(stored.type)},
                {"type", accessorType(components)}};
    if (stored.normalized)
        format["normalized"] = true;
    return dumpMembers(format);
}

// Characters that the longest number of a component type takes.
std::uint32_t numberWidth(ComponentType type) {
    switch (type) {
    case ComponentType::Int8:
        return 4;
    case ComponentType::UInt8:
        return 3;
    case ComponentType::Int16:
        return 6;
    case ComponentType::UInt16:
        return 5;
    case ComponentType::UInt32:
        return 10;
    case ComponentType::Float32:
        break;
    }
    return 15; // -1.23456789e-38
}

std::uint32_t classOfStride(ExportPlan& plan, std::size_t element_bytes) {
    const auto stride = static_cast<std::uint32_t>((element_bytes + 3) & ~std::size_t{3});
    const auto found = std::ranges::find(plan.strides, stride);
    const auto index = static_cast<std::uint32_t>(found - plan.strides.begin());
    if (found == plan.strides.end())
        plan.strides.push_back(stride);
    return kFirstStrideClass + index;
}

class MeshPlanner {
public:
    MeshPlanner(ExportPlan& plan, json& document) : plan_(plan), document_(document) {}

    void planAll() {
        json& list = document_["meshes"];
        const SourceDocument& source = *plan_.scene.source;
        plan_.submeshes.resize(plan_.scene.submeshes.size());
        plan_.meshes.resize(list.is_array() ? list.size() : 0);
        for (std::uint32_t s = 0; s < plan_.submeshes.size(); ++s) {
            plan_.submeshes[s].mesh = source.mesh_of_submesh[s];
            plan_.meshes[source.mesh_of_submesh[s]].submesh = s;
        }
        const std::vector<InstanceRange> ranges = instanceRanges(plan_.scene);
        for (std::uint32_t m = 0; m < plan_.meshes.size(); ++m) {
            MeshPlan& mesh = plan_.meshes[m];
            if (mesh.submesh == kNone) {
                planCarried(mesh, list[m]);
                continue;
            }
            plan_.submeshes[mesh.submesh].range = ranges[mesh.submesh];
            mesh.wanted = ranges[mesh.submesh].size() == 0;
            planMesh(mesh, list[m]);
        }
        plan_.content_count = contents_.count();
    }

private:
    void planCarried(MeshPlan& mesh, json& entry) {
        ReferenceVisitor visitor;
        visitor.accessor = [&](json& value) {
            const std::uint32_t number = plan_.carried.meshAccessor(value.get<std::uint32_t>());
            if (number != kNone)
                value = number;
        };
        visitMeshAccessors(entry, visitor);
        mesh.whole = dumpJson(entry);
        mesh.wanted = true;
    }

    void planMesh(MeshPlan& mesh, json& entry) {
        const Submesh& submesh = plan_.scene.submeshes[mesh.submesh];
        json primitives = std::move(entry["primitives"]);
        entry.erase("primitives");
        mesh.rest = Fragment(dumpMembers(entry));
        for (std::size_t p = 0; p < submesh.primitives.size(); ++p)
            mesh.primitives.push_back(
                planPrimitive(submesh.primitives[p], primitives[p], plan_.grids[mesh.submesh]));
    }

    PrimitivePlan planPrimitive(const Primitive& primitive, json& entry, const PositionGrid& grid) {
        PrimitivePlan to;
        const Geometry& geometry = *primitive.geometry;
        to.full = {static_cast<std::uint32_t>(geometry.positions.size()),
                   static_cast<std::uint32_t>(geometry.indices.size())};
        to.indexed = primitive.mode == PrimitiveMode::Triangles || to.full.indices > 0;
        const json& attributes = memberOrNull(entry, "attributes");
        addPositions(to, primitive, numberAt(attributes, "POSITION"), grid);
        for (std::uint32_t a = 0; a < geometry.attributes.size(); ++a)
            addAttribute(to, geometry.attributes[a], {attributes, a, kNone});
        const json& targets = memberOrNull(entry, "targets");
        static const json no_target;
        for (std::uint32_t t = 0; t < geometry.morph_targets.size(); ++t)
            for (std::uint32_t a = 0; a < geometry.morph_targets[t].attributes.size(); ++a)
                addAttribute(to,
                             geometry.morph_targets[t].attributes[a],
                             {t < targets.size() ? targets[t] : no_target, a, t});
        const bool wide = to.full.vertices > 65535;
        to.index_content = contents_.numberOf(numberAt(entry, "indices"),
                                              wide ? "index32" : "index16",
                                              std::as_bytes(std::span(geometry.indices)));
        to.first_stream = plan_.stream_count;
        plan_.stream_count += static_cast<std::uint32_t>(to.streams.size()) + 1;
        to.rest = restOf(primitive, entry);
        return to;
    }

    void addPositions(PrimitivePlan& to,
                      const Primitive& primitive,
                      std::uint32_t accessor,
                      const PositionGrid& grid) {
        StreamPlan stream;
        stream.key = "\"POSITION\":";
        stream.stored = {primitive.position_type, primitive.position_normalized};
        std::string kind = "p";
        if (grid.step > 0.0) {
            stream.stored = {ComponentType::Int16, false};
            kind += dumpJson(json{grid.step, grid.offset.x, grid.offset.y, grid.offset.z});
        }
        stream.format = formatOf(stream.stored, 3);
        stream.attribute = kPositions;
        stream.view_class = classOfStride(plan_, 3 * byteSize(stream.stored.type));
        stream.component_count = 3;
        stream.bounds_width = numberWidth(stream.stored.type);
        stream.content =
            contents_.numberOf(accessor,
                               kind + stream.format,
                               std::as_bytes(std::span(primitive.geometry->positions)));
        to.streams.push_back(std::move(stream));
    }

    // Where an attribute comes from.
    struct Origin {
        const json& accessors;   // by semantic
        std::uint32_t index = 0; // among the geometry's or the target's
        std::uint32_t target = kNone;
    };

    void addAttribute(PrimitivePlan& to, const Attribute& attribute, const Origin& origin) {
        StreamPlan stream;
        stream.key = dumpJson(attribute.semantic) + ":";
        stream.stored = origin.target == kNone ? storedType(attribute, plan_.options.compression)
                                               : StoredType{attribute.type, attribute.normalized};
        stream.format = formatOf(stream.stored, attribute.components);
        stream.attribute = origin.index;
        stream.target = origin.target;
        stream.view_class =
            classOfStride(plan_, attribute.components * byteSize(stream.stored.type));
        stream.component_count = attribute.components;
        const bool bounded = attribute.semantic == "POSITION";
        stream.bounds_width = bounded ? numberWidth(stream.stored.type) : 0;
        stream.content = contents_.numberOf(numberAt(origin.accessors, attribute.semantic),
                                            (bounded ? "p" : "a") + stream.format,
                                            attribute.bytes);
        to.streams.push_back(std::move(stream));
    }

    // Material, mode, extras and extensions; what lists vertices or compressed data is left out.
    std::string restOf(const Primitive& primitive, json& entry) {
        if (!entry.is_object())
            entry = json::object();
        for (const char* key : {"attributes", "indices", "targets", "mode"})
            entry.erase(key);
        if (primitive.mode != PrimitiveMode::Triangles)
            entry["mode"] = static_cast<int>(primitive.mode);
        if (const auto extensions = entry.find("extensions"); extensions != entry.end()) {
            extensions->erase("KHR_draco_mesh_compression");
            if (extensions->erase("CESIUM_primitive_outline") != 0)
                plan_.notes.emplace_back("left out: CESIUM_primitive_outline, it lists vertices");
            if (extensions->empty())
                entry.erase(extensions);
        }
        return entry.empty() ? std::string() : "," + dumpMembers(entry);
    }

    ExportPlan& plan_;
    json& document_;
    ContentNumbers contents_;
};

std::string sniffMimeType(std::span<const std::byte> bytes) {
    const auto starts_with = [&](std::string_view magic) {
        return bytes.size() >= magic.size() &&
               std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
    };
    if (starts_with("\x89PNG"))
        return "image/png";
    if (starts_with("\xFF\xD8\xFF"))
        return "image/jpeg";
    if (starts_with("RIFF"))
        return "image/webp";
    if (starts_with("\xABKTX 20\xBB"))
        return "image/ktx2";
    return "image/png";
}

std::string extensionOf(const std::string& mime_type) {
    if (mime_type == "image/jpeg")
        return ".jpg";
    if (mime_type == "image/webp")
        return ".webp";
    if (mime_type == "image/ktx2")
        return ".ktx2";
    return ".png";
}

// The file's own place where that is inside the folder, else its name alone, else a made-up name.
std::filesystem::path imagePath(const Scene& scene, std::size_t index, const std::string& mime) {
    const Image& image = scene.images[index];
    const bool external = !image.uri.empty() && !image.uri.starts_with("data:");
    if (external) {
        const auto path = std::filesystem::path(percentDecoded(image.uri)).lexically_normal();
        const bool outside =
            path.is_absolute() || path.begin() == path.end() || *path.begin() == "..";
        auto inside = outside ? path.filename() : path;
        if (!inside.empty() && inside.has_filename())
            return inside;
    }
    std::string name = image.name.empty() ? std::filesystem::path(scene.name).stem().string() +
                                                "_image" + std::to_string(index)
                                          : image.name;
    for (char& c : name)
        if (!isUnreserved(c) || c == '/')
            c = '_';
    const std::string extension = extensionOf(mime);
    return name.ends_with(extension) ? name : name + extension;
}

// Adds an image file; a name that other bytes have already gets a number.
std::filesystem::path fileOf(ExportPlan& plan, std::filesystem::path path, const Image& image) {
    const std::filesystem::path wanted = path;
    for (std::size_t attempt = 1;; ++attempt) {
        const auto same = std::ranges::find(plan.image_files, path, &ImageFile::path);
        if (same == plan.image_files.end()) {
            plan.image_files.push_back({path, image.bytes});
            return path;
        }
        if (same->bytes == image.bytes || *same->bytes == *image.bytes)
            return path; // one file, two references
        path = wanted;
        path.replace_filename(std::to_string(attempt) + "_" + wanted.filename().string());
    }
}

// Names the extension that allows an image's type, for textures that use the image without it: an
// embedded image has to tell its type, which core glTF then checks.
void nameImageExtensions(json& document) {
    const auto textures = document.find("textures");
    if (textures == document.end())
        return;
    for (json& texture : *textures) {
        const std::uint32_t image = numberAt(texture, "source");
        if (image >= document["images"].size())
            continue;
        const std::string mime = document["images"][image].value("mimeType", std::string());
        const char* extension = mime == "image/ktx2"   ? "KHR_texture_basisu"
                                : mime == "image/webp" ? "EXT_texture_webp"
                                                       : nullptr;
        if (extension == nullptr)
            continue;
        texture.erase("source");
        texture["extensions"][extension]["source"] = image;
        for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
            json& names = document[list];
            if (std::ranges::find(names, json(extension)) == names.end())
                names.push_back(extension);
        }
    }
}

} // namespace

void planMeshes(ExportPlan& plan, json& document) {
    MeshPlanner(plan, document).planAll();
}

void planImages(ExportPlan& plan, json& document) {
    for (std::size_t i = 0; i < plan.scene.images.size(); ++i) {
        const Image& image = plan.scene.images[i];
        json& entry = document["images"][i];
        if (!image.bytes || image.bytes->empty()) {
            entry.erase("bufferView");
            continue;
        }
        const std::string mime =
            image.mime_type.empty() ? sniffMimeType(*image.bytes) : image.mime_type;
        entry.erase("uri");
        entry.erase("bufferView");
        if (plan.options.container == Container::Glb) {
            entry["mimeType"] = mime;
            entry["bufferView"] = plan.carried.addView(*image.bytes);
            continue;
        }
        const std::filesystem::path path = fileOf(plan, imagePath(plan.scene, i, mime), image);
        entry["uri"] = percentEncoded(path.generic_string());
    }
    if (plan.options.container == Container::Glb)
        nameImageExtensions(document);
}

} // namespace lodestone
