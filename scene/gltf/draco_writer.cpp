#include "scene/gltf/draco_writer.h"

#include "scene/gltf/writer_carried.h"
#include "scene/gltf/writer_references.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <limits>
#include <map>
#include <optional>

namespace lodestone {

using nlohmann::json;

namespace {

constexpr const char* kExtension = "KHR_draco_mesh_compression";
constexpr int kTriangles = 4;
constexpr int kSpeed = 1; // of 10; 0 takes several times as long for a per mille
constexpr int kMostPositionBits = 14;
constexpr int kFewestPositionBits = 10;
constexpr int kSceneBits = 16;
constexpr int kNormalBits = 8;
constexpr int kTexcoordBits = 12;
constexpr int kColorBits = 8;
// Text of a packed primitive in the document, less what its accessors lose, roughly.
constexpr std::size_t kTextBytes = 120;

draco::DataType dataType(int component_type) {
    switch (component_type) {
    case 5120:
        return draco::DT_INT8;
    case 5121:
        return draco::DT_UINT8;
    case 5122:
        return draco::DT_INT16;
    case 5123:
        return draco::DT_UINT16;
    case 5125:
        return draco::DT_UINT32;
    default:
        return draco::DT_FLOAT32;
    }
}

draco::GeometryAttribute::Type attributeType(std::string_view semantic) {
    if (semantic == "POSITION")
        return draco::GeometryAttribute::POSITION;
    if (semantic == "NORMAL")
        return draco::GeometryAttribute::NORMAL;
    if (semantic.starts_with("TEXCOORD_"))
        return draco::GeometryAttribute::TEX_COORD;
    if (semantic.starts_with("COLOR_"))
        return draco::GeometryAttribute::COLOR;
    return draco::GeometryAttribute::GENERIC;
}

struct PackedPrimitive {
    std::vector<std::byte> bytes;
    std::map<std::string, int> ids; // by semantic: the attribute's number in the bytes
    std::size_t points = 0;
    std::size_t indices = 0;
    std::array<float, 3> min{}; // of the positions as they unpack
    std::array<float, 3> max{};
};

class DracoPacker {
public:
    explicit DracoPacker(PackedDocument& document)
        : document_(document), json_(document.json), uses_(accessorUses(document)) {}

    void pack() {
        bool any = false;
        const std::size_t mesh_count = json_.contains("meshes") ? json_["meshes"].size() : 0;
        for (std::size_t m = 0; m < mesh_count; ++m)
            for (json& primitive : json_["meshes"][m]["primitives"]) {
                std::optional<PackedPrimitive> packed;
                if (isPackable(primitive))
                    packed = encode(primitive, scaleOf(m));
                if (packed && packed->bytes.size() + kTextBytes < rawBytes(primitive)) {
                    install(primitive, *packed);
                    any = true;
                }
            }
        if (!any)
            return countRows();
        requireExtension(json_, kExtension);
        rebuild();
    }

private:
    // Nothing is packed: the rows lie where they lay.
    void countRows() {
        for (std::size_t a = 0; a < uses_.size(); ++a)
            if (uses_[a].kind == AccessorUse::Kind::Row)
                document_.row_bytes +=
                    (elementsOf(document_, a).bytes.size() + 3) & ~std::size_t{3};
    }

    bool isPackable(const json& primitive) const {
        if (primitive.value("mode", kTriangles) != kTriangles || !primitive.contains("indices") ||
            primitive.contains("targets"))
            return false;
        const auto ours = [&](const json& number) {
            return uses_[number.get<std::size_t>()].kind != AccessorUse::Kind::None;
        };
        return ours(primitive["indices"]) && std::ranges::all_of(primitive["attributes"], ours);
    }

    std::size_t rawBytes(const json& primitive) const {
        std::size_t bytes = elementsOf(document_, primitive["indices"]).bytes.size();
        for (const json& number : primitive["attributes"])
            bytes += elementsOf(document_, number).bytes.size();
        return bytes;
    }

    // How much instances of a mesh are stretched at most: rows and nodes that draw it.
    double scaleOf(std::size_t mesh) {
        if (scales_.empty())
            scales_ = meshScales();
        return scales_[mesh];
    }

    std::vector<double> meshScales() const {
        std::vector<double> scales(json_["meshes"].size(), 0.0);
        const std::vector<double> stretches = nodeStretches(json_);
        for (std::size_t n = 0; n < stretches.size(); ++n)
            if (const auto mesh = json_["nodes"][n].find("mesh"); mesh != json_["nodes"][n].end()) {
                double& known = scales[mesh->get<std::size_t>()];
                known = std::max(known, stretches[n] * largestRowScale(document_, n));
            }
        return scales;
    }

    int positionBits(const json& positions, double scale) const {
        double extent = 0.0;
        for (std::size_t c = 0; c < 3; ++c)
            extent = std::max(
                extent, positions["max"][c].get<double>() - positions["min"][c].get<double>());
        const double step = document_.diagonal * std::exp2(-kSceneBits);
        if (!(step > 0.0))
            return kMostPositionBits;
        const double steps = extent * scale / step;
        const int bits = steps > 0.0 ? static_cast<int>(std::ceil(std::log2(steps))) : 0;
        return std::clamp(bits, kFewestPositionBits, kMostPositionBits);
    }

    int quantizationBits(const std::string& semantic, const json& accessor, double scale) const {
        if (accessor["componentType"] != 5126)
            return 0;
        switch (attributeType(semantic)) {
        case draco::GeometryAttribute::POSITION:
            return positionBits(accessor, scale);
        case draco::GeometryAttribute::NORMAL:
            return kNormalBits;
        case draco::GeometryAttribute::TEX_COORD:
            return kTexcoordBits;
        case draco::GeometryAttribute::COLOR:
            return kColorBits;
        default:
            return 0;
        }
    }

    int addAttribute(draco::Mesh& mesh, const std::string& semantic, std::size_t number) const {
        const json& accessor = json_["accessors"][number];
        const StridedElements elements = elementsOf(document_, number);
        const std::size_t size = elementBytes(accessor);
        draco::GeometryAttribute format;
        format.Init(attributeType(semantic),
                    nullptr,
                    static_cast<std::uint8_t>(componentsOf(accessor)),
                    dataType(accessor["componentType"]),
                    accessor.value("normalized", false),
                    static_cast<std::int64_t>(size),
                    0);
        const int id = mesh.AddAttribute(format, true, static_cast<std::uint32_t>(elements.count));
        for (std::size_t v = 0; v < elements.count; ++v)
            mesh.attribute(id)->SetAttributeValue(
                draco::AttributeValueIndex(static_cast<std::uint32_t>(v)),
                elements.bytes.data() + v * elements.stride);
        return id;
    }

    std::optional<PackedPrimitive> encode(const json& primitive, double scale) const {
        draco::Mesh mesh;
        const std::vector<std::uint32_t> indices = indicesOf(document_, primitive["indices"]);
        const std::size_t points = elementsOf(document_, primitive["attributes"]["POSITION"]).count;
        mesh.set_num_points(static_cast<std::uint32_t>(points));
        mesh.SetNumFaces(indices.size() / 3);
        for (std::size_t f = 0; f < indices.size() / 3; ++f)
            mesh.SetFace(draco::FaceIndex(static_cast<std::uint32_t>(f)),
                         {draco::PointIndex(indices[f * 3]),
                          draco::PointIndex(indices[f * 3 + 1]),
                          draco::PointIndex(indices[f * 3 + 2])});
        std::map<std::string, int> ids;
        for (const auto& [semantic, number] : primitive["attributes"].items())
            ids[semantic] = addAttribute(mesh, semantic, number);
        draco::ExpertEncoder encoder(mesh);
        encoder.SetSpeedOptions(kSpeed, kSpeed);
        encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
        PackedPrimitive packed;
        for (const auto& [semantic, id] : ids) {
            packed.ids[semantic] = static_cast<int>(mesh.attribute(id)->unique_id());
            const int bits = quantizationBits(
                semantic,
                json_["accessors"][primitive["attributes"][semantic].get<std::size_t>()],
                scale);
            if (bits > 0)
                encoder.SetAttributeQuantization(id, bits);
        }
        draco::EncoderBuffer buffer;
        if (!encoder.EncodeToBuffer(&buffer).ok())
            return std::nullopt;
        const auto* first = reinterpret_cast<const std::byte*>(buffer.data());
        packed.bytes.assign(first, first + buffer.size());
        return measure(packed) ? std::optional(std::move(packed)) : std::nullopt;
    }

    // Unpacks again: counts and bounds in the document must be those of the unpacked data.
    static bool measure(PackedPrimitive& packed) {
        draco::DecoderBuffer buffer;
        buffer.Init(reinterpret_cast<const char*>(packed.bytes.data()), packed.bytes.size());
        draco::Decoder decoder;
        auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
        if (!decoded.ok())
            return false;
        const draco::Mesh& mesh = *decoded.value();
        packed.points = mesh.num_points();
        packed.indices = std::size_t{mesh.num_faces()} * 3;
        const draco::PointAttribute* positions =
            mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
        packed.min.fill(std::numeric_limits<float>::infinity());
        packed.max.fill(-std::numeric_limits<float>::infinity());
        for (std::uint32_t v = 0; v < packed.points; ++v) {
            std::array<float, 3> at{};
            if (!positions->ConvertValue<float>(
                    positions->mapped_index(draco::PointIndex(v)), 3, at.data()))
                return false;
            for (std::size_t c = 0; c < 3; ++c) {
                packed.min[c] = std::min(packed.min[c], at[c]);
                packed.max[c] = std::max(packed.max[c], at[c]);
            }
        }
        return packed.points > 0;
    }

    // The number of an accessor for one user alone.
    std::size_t ownAccessor(json& number) {
        AccessorUse& use = uses_[number.get<std::size_t>()];
        if (use.users > 1) {
            --use.users;
            const json copy = json_["accessors"][number.get<std::size_t>()];
            number = json_["accessors"].size();
            json_["accessors"].push_back(copy);
            uses_.push_back({});
        }
        uses_[number.get<std::size_t>()].kind = AccessorUse::Kind::None;
        return number.get<std::size_t>();
    }

    static void unplace(json& accessor, std::size_t count) {
        accessor.erase("bufferView");
        accessor.erase("byteOffset");
        accessor["count"] = count;
    }

    void install(json& primitive, const PackedPrimitive& packed) {
        document_.dropped_triangles +=
            (elementsOf(document_, primitive["indices"]).count - packed.indices) / 3;
        for (auto& [semantic, number] : primitive["attributes"].items()) {
            json& accessor = json_["accessors"][ownAccessor(number)];
            unplace(accessor, packed.points);
            if (semantic == "POSITION" && accessor["componentType"] == 5126) {
                accessor["min"] = packed.min;
                accessor["max"] = packed.max;
            }
        }
        json& indices = json_["accessors"][ownAccessor(primitive["indices"])];
        unplace(indices, packed.indices);
        indices["componentType"] = packed.points > 65535 ? 5125 : 5123;
        primitive["extensions"][kExtension] = {{"bufferView", views_.size()},
                                               {"attributes", packed.ids}};
        view_numbers_.push_back(&primitive["extensions"][kExtension]["bufferView"]);
        views_.push_back(packed.bytes);
    }

    struct View { // NOLINT(bugprone-exception-escape): json moves without throwing
        json entry;
        std::vector<std::byte> bytes;
    };

    // Views of what was not packed lose what was; those of packed primitives come after.
    void rebuild() {
        std::map<std::size_t, View> kept;
        for (std::size_t a = 0; a < uses_.size(); ++a) {
            if (uses_[a].kind == AccessorUse::Kind::None)
                continue;
            json& accessor = json_["accessors"][a];
            const std::size_t old = accessor["bufferView"];
            View& view = kept[old];
            view.entry = json_["bufferViews"][old];
            const StridedElements elements = elementsOf(document_, a);
            if (uses_[a].kind == AccessorUse::Kind::Row)
                document_.row_bytes += (elements.bytes.size() + 3) & ~std::size_t{3};
            accessor["byteOffset"] = view.bytes.size();
            if (view.bytes.empty())
                accessor.erase("byteOffset");
            view.bytes.insert(view.bytes.end(), elements.bytes.begin(), elements.bytes.end());
            padTo4(view.bytes);
        }
        json list = json::array();
        for (std::uint32_t v = 0; v < document_.first_view; ++v)
            list.push_back(json_["bufferViews"][v]);
        const auto carried = std::span(document_.binary).first(document_.first_byte);
        std::vector<std::byte> binary(carried.begin(), carried.end());
        std::map<std::size_t, std::size_t> renumbered;
        const auto append = [&](json entry, std::span<const std::byte> bytes) {
            entry["buffer"] = 0;
            entry["byteOffset"] = binary.size();
            entry["byteLength"] = bytes.size();
            list.push_back(std::move(entry));
            binary.insert(binary.end(), bytes.begin(), bytes.end());
            padTo4(binary);
        };
        for (auto& [old, view] : kept) {
            renumbered[old] = list.size();
            append(std::move(view.entry), view.bytes);
        }
        const std::size_t first_packed = list.size();
        for (const std::vector<std::byte>& bytes : views_)
            append(json::object(), bytes);
        for (std::size_t a = 0; a < uses_.size(); ++a)
            if (uses_[a].kind != AccessorUse::Kind::None)
                json_["accessors"][a]["bufferView"] =
                    renumbered[json_["accessors"][a]["bufferView"].get<std::size_t>()];
        for (json* number : view_numbers_)
            *number = number->get<std::size_t>() + first_packed;
        json_["bufferViews"] = std::move(list);
        json_["buffers"][0]["byteLength"] = binary.size();
        document_.binary = std::move(binary);
    }

    PackedDocument& document_;
    json& json_;
    std::vector<AccessorUse> uses_;             // [accessors]; None: carried or packed
    std::vector<double> scales_;                // [meshes] once asked for
    std::vector<std::vector<std::byte>> views_; // of packed primitives
    std::vector<json*> view_numbers_;           // [views_] where the document names them
};

} // namespace

void packDraco(PackedDocument& document) {
    DracoPacker(document).pack();
}

} // namespace lodestone
