#include "scene/gltf/writer_carried.h"

#include "scene/gltf/json_sink.h"

#include <algorithm>
#include <cstring>

namespace lodestone {

using nlohmann::json;

namespace {

// Stands for the number of a packed view until all views are known.
std::string packedView(CarriedData::Use use) {
    return "packed " + std::to_string(static_cast<int>(use));
}

std::uint64_t numberOr(const json& object, const char* key, std::uint64_t fallback) {
    const auto found = object.find(key);
    return found != object.end() && found->is_number_unsigned() ? found->get<std::uint64_t>()
                                                                : fallback;
}

std::size_t componentBytes(std::uint64_t type) {
    switch (type) {
    case 5120:
    case 5121:
        return 1;
    case 5122:
    case 5123:
        return 2;
    case 5125:
    case 5126:
        return 4;
    default:
        return 0;
    }
}

std::uint64_t paddedTo4(std::uint64_t size) {
    return (size + 3) & ~std::uint64_t{3};
}

// The bytes of a view, or none if it lies outside its buffer.
std::span<const std::byte> viewBytes(const SourceDocument& source, std::uint64_t number) {
    const auto views = source.json.find("bufferViews");
    if (views == source.json.end() || number >= views->size())
        return {};
    const json& view = (*views)[number];
    const std::uint64_t buffer = numberOr(view, "buffer", ~0ULL);
    const std::uint64_t offset = numberOr(view, "byteOffset", 0);
    const std::uint64_t length = numberOr(view, "byteLength", 0);
    if (buffer >= source.buffers->size())
        return {};
    const std::vector<std::byte>& bytes = (*source.buffers)[buffer];
    if (offset > bytes.size() || length > bytes.size() - offset)
        return {};
    return std::span(bytes).subspan(offset, length);
}

// Elements at the given place, `count` at most as many as the view holds.
std::vector<std::byte> gather(std::span<const std::byte> view,
                              const json& place,
                              std::size_t element_bytes,
                              std::uint64_t count,
                              std::uint64_t stride) {
    const std::uint64_t offset = numberOr(place, "byteOffset", 0);
    std::vector<std::byte> packed;
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t at = offset + i * stride;
        if (at > view.size() || element_bytes > view.size() - at)
            break;
        const auto element = view.subspan(at, element_bytes);
        packed.insert(packed.end(), element.begin(), element.end());
    }
    return packed;
}

} // namespace

std::size_t elementBytes(const json& accessor) {
    const std::size_t component = componentBytes(numberOr(accessor, "componentType", 0));
    const auto found = accessor.find("type");
    if (found == accessor.end() || !found->is_string())
        return 0;
    const std::string type = *found;
    if (type == "SCALAR")
        return component;
    if (type.starts_with("VEC") && type.size() == 4)
        return component * static_cast<std::size_t>(type[3] - '0');
    if (type.starts_with("MAT") && type.size() == 4) {
        const auto size = static_cast<std::size_t>(type[3] - '0');
        return size * paddedTo4(size * component);
    }
    return 0;
}

PackedElements packElements(const SourceDocument& source, const json& accessor) {
    PackedElements packed;
    packed.element_bytes = elementBytes(accessor);
    const std::uint64_t number = numberOr(accessor, "bufferView", ~0ULL);
    const std::span<const std::byte> view = viewBytes(source, number);
    if (view.empty() || packed.element_bytes == 0)
        return packed;
    const std::uint64_t stride =
        numberOr(source.json["bufferViews"][number], "byteStride", packed.element_bytes);
    const std::uint64_t count = numberOr(accessor, "count", 0);
    packed.bytes =
        gather(view, accessor, packed.element_bytes, count, std::max<std::uint64_t>(stride, 1));
    if (count <= view.size()) // an unchecked count must not size an allocation
        packed.bytes.resize(count * packed.element_bytes);
    return packed;
}

PackedElements
resolvedElements(const SourceDocument& source, const json& accessor, std::size_t count) {
    PackedElements packed = packElements(source, accessor);
    packed.bytes.resize(count * packed.element_bytes);
    const auto sparse = accessor.find("sparse");
    if (sparse == accessor.end() || !sparse->is_object())
        return packed;
    const json places = sparse->value("indices", json::object());
    const std::size_t index_bytes = componentBytes(numberOr(places, "componentType", 0));
    const auto part = [&](const char* key, std::size_t element_bytes) {
        const json place = sparse->value(key, json::object());
        return gather(viewBytes(source, numberOr(place, "bufferView", ~0ULL)),
                      place,
                      element_bytes,
                      std::min<std::uint64_t>(numberOr(*sparse, "count", 0), count),
                      element_bytes);
    };
    if (index_bytes == 0 || packed.element_bytes == 0)
        return packed;
    const std::vector<std::byte> indices = part("indices", index_bytes);
    const std::vector<std::byte> values = part("values", packed.element_bytes);
    const std::size_t known =
        std::min(indices.size() / index_bytes, values.size() / packed.element_bytes);
    for (std::size_t i = 0; i < known; ++i) {
        std::uint32_t element = 0; // little-endian, as glTF
        std::memcpy(&element, indices.data() + i * index_bytes, index_bytes);
        if (element < count)
            std::memcpy(packed.bytes.data() + element * packed.element_bytes,
                        values.data() + i * packed.element_bytes,
                        packed.element_bytes);
    }
    return packed;
}

void CarriedData::placePacked(json& place, Use use, std::span<const std::byte> bytes) {
    std::vector<std::byte>& packed = packed_[static_cast<std::size_t>(use)];
    place["bufferView"] = packedView(use);
    place["byteOffset"] = packed.size();
    packed.insert(packed.end(), bytes.begin(), bytes.end());
    packed.resize(paddedTo4(packed.size()));
}

void CarriedData::packSparse(json& accessor) {
    json& sparse = accessor["sparse"];
    const std::uint64_t count = numberOr(sparse, "count", 0);
    for (const char* part : {"indices", "values"}) {
        json& place = sparse[part];
        const bool is_indices = std::string_view(part) == "indices";
        const std::size_t size = is_indices ? componentBytes(numberOr(place, "componentType", 0))
                                            : elementBytes(accessor);
        const auto view = viewBytes(source_, numberOr(place, "bufferView", ~0ULL));
        placePacked(place, Use::Sparse, gather(view, place, size, count, size));
    }
}

template <class PlaceData>
std::uint32_t CarriedData::carry(std::uint32_t source_accessor, const PlaceData& place_data) {
    if (const auto known = accessor_numbers_.find(source_accessor);
        known != accessor_numbers_.end())
        return known->second;
    const auto list = source_.json.find("accessors");
    if (list == source_.json.end() || source_accessor >= list->size())
        return kNone;
    json entry = (*list)[source_accessor];
    if (entry.contains("bufferView"))
        place_data(entry);
    else
        entry.erase("byteOffset");
    if (entry.contains("sparse") && entry["sparse"].is_object())
        packSparse(entry);
    accessors_.push_back(std::move(entry));
    return accessor_numbers_[source_accessor] = accessorCount() - 1;
}

std::uint32_t CarriedData::accessor(std::uint32_t source_accessor, Use use) {
    return carry(source_accessor,
                 [&](json& entry) { placePacked(entry, use, packElements(source_, entry).bytes); });
}

std::uint32_t CarriedData::meshAccessor(std::uint32_t source_accessor) {
    return carry(source_accessor, [&](json& entry) {
        const PackedElements packed = packElements(source_, entry);
        const bool is_index = entry["type"] == "SCALAR" && entry["componentType"] != 5126;
        const std::size_t size = packed.element_bytes;
        const std::size_t stride = is_index ? size : paddedTo4(size);
        std::vector<std::byte> bytes(size == 0 ? 0 : packed.bytes.size() / size * stride);
        for (std::size_t from = 0, to = 0; from < packed.bytes.size(); from += size, to += stride)
            std::memcpy(bytes.data() + to, packed.bytes.data() + from, size);
        entry["bufferView"] = views_.size();
        entry.erase("byteOffset");
        strided_.push_back(std::move(bytes));
        views_.push_back({strided_.back(), is_index ? 0U : static_cast<std::uint32_t>(stride)});
    });
}

std::uint32_t CarriedData::bufferView(std::uint32_t source_view) {
    if (const auto known = view_numbers_.find(source_view); known != view_numbers_.end())
        return known->second;
    const std::span<const std::byte> bytes = viewBytes(source_, source_view);
    if (bytes.empty())
        return kNone;
    const std::uint64_t stride =
        numberOr(source_.json["bufferViews"][source_view], "byteStride", 0);
    views_.push_back({bytes, static_cast<std::uint32_t>(stride)});
    return view_numbers_[source_view] = viewCount() - 1;
}

std::uint32_t CarriedData::addView(std::span<const std::byte> bytes) {
    const auto [known, is_new] = added_views_.try_emplace(bytes.data(), viewCount());
    if (is_new)
        views_.push_back({bytes, 0});
    return known->second;
}

void CarriedData::finish() {
    std::map<std::string, std::uint32_t> packed_views;
    for (const Use use : {Use::Skin, Use::Sparse, Use::Other})
        if (const auto& bytes = packed_[static_cast<std::size_t>(use)]; !bytes.empty()) {
            packed_views[packedView(use)] = viewCount();
            views_.push_back({bytes, 0});
        }
    const auto resolve = [&](json& place) {
        if (const auto view = place.find("bufferView"); view != place.end() && view->is_string())
            *view = packed_views[view->get<std::string>()];
    };
    json accessors = json::array();
    for (json& accessor : accessors_) {
        resolve(accessor);
        if (accessor.contains("sparse") && accessor["sparse"].is_object())
            for (const char* part : {"indices", "values"})
                resolve(accessor["sparse"][part]);
        accessors.push_back(std::move(accessor));
    }
    json views = json::array();
    for (const View& view : views_) {
        json entry{{"buffer", 0}, {"byteLength", view.bytes.size()}, {"byteOffset", size_bytes_}};
        if (view.byte_stride != 0)
            entry["byteStride"] = view.byte_stride;
        views.push_back(std::move(entry));
        size_bytes_ += paddedTo4(view.bytes.size());
    }
    const auto inner = [](const json& list) {
        const std::string text = dumpJson(list);
        return text.substr(1, text.size() - 2);
    };
    accessors_json_ = inner(accessors);
    views_json_ = inner(views);
}

void CarriedData::appendTo(std::vector<std::byte>& binary) const {
    for (const View& view : views_) {
        binary.insert(binary.end(), view.bytes.begin(), view.bytes.end());
        binary.resize(paddedTo4(binary.size()));
    }
}

} // namespace lodestone
