#include "scene/gltf/draco_reader.h"

#include <draco/compression/decode.h>
#include <draco/core/decoder_buffer.h>
#include <draco/mesh/mesh.h>
#include <limits>

namespace lodestone {

using nlohmann::json;

namespace {

constexpr const char* kExtension = "KHR_draco_mesh_compression";

tl::unexpected<Error> wrong(const std::string& fault) {
    return badInput(std::string(kExtension) + ": " + fault + ": re-export the file");
}

template <class T>
bool convertTo(const draco::PointAttribute& from, AccessorData& to) {
    to.bytes.resize(to.count * to.components * sizeof(T));
    for (std::uint64_t v = 0; v < to.count; ++v) {
        T values[4]{};
        const auto index = from.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(v)));
        if (!from.ConvertValue<T>(index, static_cast<std::int8_t>(to.components), values))
            return false;
        std::memcpy(
            to.bytes.data() + v * to.components * sizeof(T), values, to.components * sizeof(T));
    }
    return true;
}

bool convert(const draco::PointAttribute& from, AccessorData& to) {
    switch (to.type) {
    case ComponentType::Int8:
        return convertTo<std::int8_t>(from, to);
    case ComponentType::UInt8:
        return convertTo<std::uint8_t>(from, to);
    case ComponentType::Int16:
        return convertTo<std::int16_t>(from, to);
    case ComponentType::UInt16:
        return convertTo<std::uint16_t>(from, to);
    case ComponentType::UInt32:
        return convertTo<std::uint32_t>(from, to);
    case ComponentType::Float32:
        return convertTo<float>(from, to);
    }
    return false;
}

Result<std::unique_ptr<draco::Mesh>> decodeMesh(std::span<const std::byte> bytes) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
        return wrong("the data are damaged or no triangles");
    return std::move(decoded).value();
}

Result<AccessorPtr>
decodedAttribute(const draco::Mesh& mesh, std::uint64_t id, Result<AccessorData> format) {
    if (!format)
        return tl::make_unexpected(format.error());
    const draco::PointAttribute* from =
        id > std::numeric_limits<std::uint32_t>::max()
            ? nullptr
            : mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
    if (from == nullptr)
        return wrong("attribute " + std::to_string(id) + " is not among the data");
    if (format->matrix || format->components > 4 || from->num_components() != format->components)
        return wrong("attribute " + std::to_string(id) + " has " +
                     std::to_string(from->num_components()) + " components, its accessor " +
                     std::to_string(format->components));
    auto data = std::make_shared<AccessorData>(std::move(*format));
    data->count = mesh.num_points();
    if (!convert(*from, *data))
        return wrong("attribute " + std::to_string(id) + " does not fit its accessor's type");
    return AccessorPtr(std::move(data));
}

Result<std::vector<std::uint32_t>> decodedIndices(const draco::Mesh& mesh) {
    std::vector<std::uint32_t> indices;
    indices.reserve(std::size_t{mesh.num_faces()} * 3);
    for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
        for (const draco::PointIndex& corner : mesh.face(f)) {
            if (corner.value() >= mesh.num_points())
                return wrong("an index is out of range");
            indices.push_back(corner.value());
        }
    return indices;
}

} // namespace

Result<std::optional<DracoPrimitive>> readDraco(const json& primitive,
                                                const AccessorReader& accessors) {
    const json* words = extension(primitive, kExtension);
    if (words == nullptr)
        return std::nullopt;
    const json& document = accessors.document().json;
    const json& named = primitive["attributes"];
    if (listOf(document, "accessors")[*unsignedMember(named, "POSITION")].contains("bufferView"))
        return std::nullopt;
    const std::optional<std::uint64_t> view = unsignedMember(*words, "bufferView");
    const json* map = member(*words, "attributes");
    if (!view || *view >= listOf(document, "bufferViews").size() || map == nullptr ||
        !map->is_object())
        return wrong("its buffer view or its attributes are missing");
    Result<std::span<const std::byte>> bytes = accessors.view(*view);
    if (!bytes)
        return tl::make_unexpected(bytes.error());
    Result<std::unique_ptr<draco::Mesh>> mesh = decodeMesh(*bytes);
    if (!mesh)
        return tl::make_unexpected(mesh.error());
    DracoPrimitive primitive_data;
    for (const auto& [semantic, id] : map->items()) {
        const std::optional<std::uint64_t> accessor = unsignedMember(named, semantic);
        const std::optional<std::uint64_t> number = asUnsigned(id);
        if (!accessor || !number)
            return wrong("attribute " + semantic.substr(0, 60) + " is not one of the primitive's");
        Result<AccessorPtr> data = decodedAttribute(**mesh, *number, accessors.format(*accessor));
        if (!data)
            return badInput(semantic.substr(0, 60) + ": " + data.error().message);
        primitive_data.attributes.emplace(semantic, std::move(*data));
    }
    Result<std::vector<std::uint32_t>> indices = decodedIndices(**mesh);
    if (!indices)
        return tl::make_unexpected(indices.error());
    primitive_data.indices = std::move(*indices);
    return primitive_data;
}

} // namespace lodestone
