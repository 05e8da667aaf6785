#pragma once
// Data that passes from the source document to an export untouched: accessors of animations, skins
// and extensions, whole buffer views of extensions, embedded images. Carried accessors and views
// come first in an export, so that their numbers and offsets are the same in every LOD.
#include "scene/gltf/source_document.h"

#include <array>
#include <map>
#include <span>

namespace lodestone {

// Elements of an accessor of the source, packed without stride.
struct PackedElements {
    std::size_t element_bytes = 0;
    std::vector<std::byte> bytes; // [count * element_bytes]; zeros where the file has no data
};

// Bytes of one element of an accessor, with the column padding of small matrices; 0 if unknown.
std::size_t elementBytes(const nlohmann::json& accessor);
// Sparse values are not applied. Out of range: zeros, and no more than the buffers hold is made.
PackedElements packElements(const SourceDocument& source, const nlohmann::json& accessor);
// The first `count` elements with sparse values applied; zeros where there is no data.
PackedElements
resolvedElements(const SourceDocument& source, const nlohmann::json& accessor, std::size_t count);

class CarriedData {
public:
    explicit CarriedData(const SourceDocument& source) : source_(source) {}

    // Inverse bind matrices share no view with anything else, nor do sparse parts.
    enum class Use : std::uint8_t { Skin, Sparse, Other };

    // Numbers in the export; the same source number gives the same again. kNone: not in the source.
    std::uint32_t accessor(std::uint32_t source_accessor, Use use = Use::Other);
    // An accessor of a mesh that is passed on whole: a view of its own, strides multiples of 4.
    std::uint32_t meshAccessor(std::uint32_t source_accessor);
    std::uint32_t bufferView(std::uint32_t source_view);
    // bytes must outlive this object.
    std::uint32_t addView(std::span<const std::byte> bytes);

    // Closes the lists; nothing is added afterwards.
    void finish();

    std::uint32_t accessorCount() const { return static_cast<std::uint32_t>(accessors_.size()); }

    std::uint32_t viewCount() const { return static_cast<std::uint32_t>(views_.size()); }

    // Comma separated entries, after finish().
    const std::string& accessorsJson() const { return accessors_json_; }

    const std::string& viewsJson() const { return views_json_; }

    std::uint64_t sizeBytes() const { return size_bytes_; } // padded to 4

    void appendTo(std::vector<std::byte>& binary) const;

private:
    struct View {
        std::span<const std::byte> bytes;
        std::uint32_t byte_stride = 0; // 0: none
    };

    // The accessor's number; place_data(entry) puts its elements where the entry then says.
    template <class PlaceData>
    std::uint32_t carry(std::uint32_t source_accessor, const PlaceData& place_data);
    // Appends to the view of that use and makes `place` refer to it.
    void placePacked(nlohmann::json& place, Use use, std::span<const std::byte> bytes);
    void packSparse(nlohmann::json& accessor);

    const SourceDocument& source_;
    std::map<std::uint32_t, std::uint32_t> accessor_numbers_;
    std::map<std::uint32_t, std::uint32_t> view_numbers_;
    std::map<const std::byte*, std::uint32_t> added_views_;
    std::vector<nlohmann::json> accessors_;
    std::vector<View> views_;
    std::array<std::vector<std::byte>, 3> packed_; // [uses] accessors, one view for each use
    std::vector<std::vector<std::byte>> strided_;  // accessors of carried meshes
    std::string accessors_json_;
    std::string views_json_;
    std::uint64_t size_bytes_ = 0;
};

} // namespace lodestone
