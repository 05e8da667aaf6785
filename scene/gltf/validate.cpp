#include "scene/gltf/validate.h"

#include "scene/gltf/read_context.h"

#include <array>
#include <span>

namespace lodestone {

using nlohmann::json;

namespace {

enum class Kind {
    Bool,
    Number,
    Unsigned,
    String,
    Numbers, // length 0: any
    Strings,
    Index,    // into `target`
    Indices,  // into `target`
    IndexMap, // object of indices into `target`
    IndexMaps,
    Object,  // of `schema`
    Objects, // array of `schema`
};

struct Field {
    std::string_view key;
    Kind kind = Kind::Object;
    std::string_view target;
    std::span<const Field> schema;
    std::size_t length = 0;
    bool required = false;
};

constexpr Field text(std::string_view key) {
    return {key, Kind::String, {}, {}, 0, false};
}

constexpr Field number(std::string_view key) {
    return {key, Kind::Number, {}, {}, 0, false};
}

constexpr Field flag(std::string_view key) {
    return {key, Kind::Bool, {}, {}, 0, false};
}

constexpr Field numbers(std::string_view key, std::size_t length) {
    return {key, Kind::Numbers, {}, {}, length, false};
}

constexpr Field whole(std::string_view key) {
    return {key, Kind::Unsigned, {}, {}, 0, false};
}

constexpr Field index(std::string_view key, std::string_view target) {
    return {key, Kind::Index, target, {}, 0, false};
}

constexpr Field indices(std::string_view key, std::string_view target) {
    return {key, Kind::Indices, target, {}, 0, false};
}

constexpr Field object(std::string_view key, std::span<const Field> schema) {
    return {key, Kind::Object, {}, schema, 0, false};
}

constexpr Field objects(std::string_view key, std::span<const Field> schema) {
    return {key, Kind::Objects, {}, schema, 0, false};
}

constexpr Field needed(Field field) {
    field.required = true;
    return field;
}

constexpr std::array kAsset{needed(text("version")), text("minVersion"), text("generator")};
constexpr std::array kBuffer{text("uri"), needed(whole("byteLength")), text("name")};
constexpr std::array kBufferView{needed(index("buffer", "buffers")),
                                 whole("byteOffset"),
                                 needed(whole("byteLength")),
                                 whole("byteStride"),
                                 whole("target"),
                                 text("name")};
constexpr std::array kSparseIndices{needed(index("bufferView", "bufferViews")),
                                    whole("byteOffset"),
                                    needed(whole("componentType"))};
constexpr std::array kSparseValues{needed(index("bufferView", "bufferViews")), whole("byteOffset")};
constexpr std::array kSparse{needed(whole("count")),
                             needed(object("indices", kSparseIndices)),
                             needed(object("values", kSparseValues))};
constexpr std::array kAccessor{index("bufferView", "bufferViews"),
                               whole("byteOffset"),
                               needed(whole("componentType")),
                               flag("normalized"),
                               needed(whole("count")),
                               needed(text("type")),
                               numbers("max", 0),
                               numbers("min", 0),
                               object("sparse", kSparse),
                               text("name")};
constexpr std::array kPrimitive{
    needed(Field{"attributes", Kind::IndexMap, "accessors", {}, 0, true}),
    index("indices", "accessors"),
    index("material", "materials"),
    whole("mode"),
    Field{"targets", Kind::IndexMaps, "accessors", {}, 0, false}};
constexpr std::array kMesh{
    needed(objects("primitives", kPrimitive)), numbers("weights", 0), text("name")};
constexpr std::array kNode{text("name"),
                           index("mesh", "meshes"),
                           index("camera", "cameras"),
                           index("skin", "skins"),
                           indices("children", "nodes"),
                           numbers("translation", 3),
                           numbers("rotation", 4),
                           numbers("scale", 3),
                           numbers("matrix", 16),
                           numbers("weights", 0)};
constexpr std::array kScene{text("name"), indices("nodes", "nodes")};
constexpr std::array kSkin{index("inverseBindMatrices", "accessors"),
                           index("skeleton", "nodes"),
                           needed(indices("joints", "nodes")),
                           text("name")};
constexpr std::array kPerspective{
    number("aspectRatio"), needed(number("yfov")), number("zfar"), needed(number("znear"))};
constexpr std::array kOrthographic{needed(number("xmag")),
                                   needed(number("ymag")),
                                   needed(number("zfar")),
                                   needed(number("znear"))};
constexpr std::array kCamera{needed(text("type")),
                             object("perspective", kPerspective),
                             object("orthographic", kOrthographic),
                             text("name")};
constexpr std::array kTextureInfo{
    needed(index("index", "textures")), whole("texCoord"), number("scale"), number("strength")};
constexpr std::array kPbr{numbers("baseColorFactor", 4),
                          object("baseColorTexture", kTextureInfo),
                          number("metallicFactor"),
                          number("roughnessFactor"),
                          object("metallicRoughnessTexture", kTextureInfo)};
constexpr std::array kMaterial{text("name"),
                               object("pbrMetallicRoughness", kPbr),
                               object("normalTexture", kTextureInfo),
                               object("occlusionTexture", kTextureInfo),
                               object("emissiveTexture", kTextureInfo),
                               numbers("emissiveFactor", 3),
                               text("alphaMode"),
                               number("alphaCutoff"),
                               flag("doubleSided")};
constexpr std::array kTexture{
    index("sampler", "samplers"), index("source", "images"), text("name")};
constexpr std::array kImage{
    text("uri"), text("mimeType"), index("bufferView", "bufferViews"), text("name")};
constexpr std::array kSampler{
    whole("magFilter"), whole("minFilter"), whole("wrapS"), whole("wrapT")};
constexpr std::array kChannelTarget{index("node", "nodes"), needed(text("path"))};
constexpr std::array kChannel{needed(whole("sampler")), needed(object("target", kChannelTarget))};
constexpr std::array kAnimationSampler{needed(index("input", "accessors")),
                                       text("interpolation"),
                                       needed(index("output", "accessors"))};
constexpr std::array kAnimation{needed(objects("channels", kChannel)),
                                needed(objects("samplers", kAnimationSampler)),
                                text("name")};
constexpr std::array kRoot{needed(object("asset", kAsset)),
                           Field{"extensionsUsed", Kind::Strings, {}, {}, 0, false},
                           Field{"extensionsRequired", Kind::Strings, {}, {}, 0, false},
                           objects("buffers", kBuffer),
                           objects("bufferViews", kBufferView),
                           objects("accessors", kAccessor),
                           objects("meshes", kMesh),
                           objects("nodes", kNode),
                           objects("scenes", kScene),
                           index("scene", "scenes"),
                           objects("skins", kSkin),
                           objects("cameras", kCamera),
                           objects("materials", kMaterial),
                           objects("textures", kTexture),
                           objects("images", kImage),
                           objects("samplers", kSampler),
                           objects("animations", kAnimation)};

class Validator {
public:
    explicit Validator(const json& document) : document_(document) {}

    Result<void>
    checkObject(const json& value, std::span<const Field> schema, const std::string& where) const {
        if (!value.is_object())
            return wrong(where, "an object");
        if (const json* extensions = member(value, "extensions"))
            if (!extensions->is_object())
                return wrong(joined(where, "extensions"), "an object");
        for (const Field& field : schema) {
            const json* found = member(value, field.key);
            if (found == nullptr) {
                if (field.required)
                    return badInput(joined(where, field.key) + " is missing: re-export the file");
                continue;
            }
            if (Result<void> checked = checkField(*found, field, where); !checked)
                return checked;
        }
        return {};
    }

private:
    static std::string joined(const std::string& where, std::string_view key) {
        return where.empty() ? std::string(key) : where + "." + std::string(key);
    }

    static tl::unexpected<Error> wrong(const std::string& where, const std::string& expected) {
        return badInput(where + " is not " + expected + ": re-export the file");
    }

    Result<void>
    checkField(const json& value, const Field& field, const std::string& parent) const {
        // The path is spelled out only where a nested check or an error needs it.
        const auto where = [&] { return joined(parent, field.key); };
        switch (field.kind) {
        case Kind::Bool:
            return value.is_boolean() ? Result<void>{} : wrong(where(), "true or false");
        case Kind::Number:
            return value.is_number() ? Result<void>{} : wrong(where(), "a number");
        case Kind::Unsigned:
            return asUnsigned(value) ? Result<void>{} : wrong(where(), "a whole number >= 0");
        case Kind::String:
            return value.is_string() ? Result<void>{} : wrong(where(), "a text");
        case Kind::Numbers:
            return checkNumbers(value, field.length, where);
        case Kind::Index:
            return checkIndex(value, field.target, where);
        case Kind::Object:
            return checkObject(value, field.schema, where());
        case Kind::IndexMap:
            return checkIndexMap(value, field.target, where());
        case Kind::Strings:
        case Kind::Indices:
        case Kind::IndexMaps:
        case Kind::Objects:
            return checkElements(value, field, where());
        }
        return {};
    }

    Result<void>
    checkElements(const json& value, const Field& field, const std::string& where) const {
        if (!value.is_array())
            return wrong(where, "a list");
        for (std::size_t i = 0; i < value.size(); ++i) {
            const auto element = [&] { return where + "[" + std::to_string(i) + "]"; };
            Result<void> checked;
            if (field.kind == Kind::Strings && !value[i].is_string())
                checked = wrong(element(), "a text");
            else if (field.kind == Kind::Indices)
                checked = checkIndex(value[i], field.target, element);
            else if (field.kind == Kind::IndexMaps)
                checked = checkIndexMap(value[i], field.target, element());
            else if (field.kind == Kind::Objects)
                checked = checkObject(value[i], field.schema, element());
            if (!checked)
                return checked;
        }
        return {};
    }

    template <class Where>
    static Result<void> checkNumbers(const json& value, std::size_t length, const Where& where) {
        if (!value.is_array() || (length != 0 && value.size() != length))
            return wrong(where(),
                         length == 0 ? "a list of numbers"
                                     : "a list of " + std::to_string(length) + " numbers");
        for (const json& element : value)
            if (!element.is_number())
                return wrong(where(), "a list of numbers");
        return {};
    }

    template <class Where>
    Result<void> checkIndex(const json& value, std::string_view target, const Where& where) const {
        const std::optional<std::uint64_t> number = asUnsigned(value);
        if (!number)
            return wrong(where(), "an index (a whole number >= 0)");
        const std::size_t size = listOf(document_, target).size();
        if (*number >= size)
            return badInput(where() + " is " + std::to_string(*number) +
                            ", which is out of range (" + std::to_string(size) + " " +
                            std::string(target) + "): re-export the file");
        return {};
    }

    Result<void>
    checkIndexMap(const json& value, std::string_view target, const std::string& where) const {
        if (!value.is_object())
            return wrong(where, "an object");
        for (const auto& [key, element] : value.items())
            if (Result<void> checked =
                    checkIndex(element,
                               target,
                               [&where, &name = key] { return joined(where, name.substr(0, 60)); });
                !checked)
                return checked;
        return {};
    }

    const json& document_;
};

Result<void> checkVersion(const json& document) {
    const json* asset = member(document, "asset");
    const std::string version = asset == nullptr ? "" : stringMember(*asset, "version");
    const json* meshes = member(document, "meshes");
    if (version.starts_with("1") || (meshes != nullptr && meshes->is_object()))
        return badInput("glTF 1.0 is not supported: convert it to glTF 2.0");
    if (asset == nullptr)
        return badInput("JSON has no \"asset\", so this is not a glTF 2.0 file");
    if (!version.empty() && !version.starts_with("2."))
        return badInput("glTF version " + version.substr(0, 20) +
                        " is not supported: export as glTF 2.0");
    const std::string min_version = stringMember(*asset, "minVersion");
    if (!min_version.empty() && min_version != "2.0")
        return badInput("needs a reader of glTF " + min_version.substr(0, 20) +
                        ": export as glTF 2.0");
    return {};
}

} // namespace

Result<void> validateDocument(const json& document) {
    if (Result<void> version = checkVersion(document); !version)
        return version;
    return Validator(document).checkObject(document, kRoot, "");
}

} // namespace lodestone
