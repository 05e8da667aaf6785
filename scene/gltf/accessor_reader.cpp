#include "scene/gltf/accessor_reader.h"

#include <cstring>

namespace lodestone {

using nlohmann::json;

namespace {

constexpr std::uint64_t kMaxZeroElements = 16'777'216;

struct Layout {
    ComponentType type = ComponentType::Float32;
    std::size_t columns = 1;
    std::size_t rows = 1;
    std::size_t column_stride = 4; // bytes from one column to the next in the file

    std::size_t packedColumn() const { return rows * byteSize(type); }

    std::size_t packedElement() const { return columns * packedColumn(); }

    // Bytes an element spans in the file: columns of matrices start at multiples of four.
    std::size_t fileElement() const { return columns * column_stride; }
};

std::optional<ComponentType> componentType(std::uint64_t code) {
    switch (code) {
    case 5120:
    case 5121:
    case 5122:
    case 5123:
    case 5125:
    case 5126:
        return static_cast<ComponentType>(code);
    default:
        return std::nullopt;
    }
}

std::optional<Layout> layoutOf(const json& accessor) {
    const std::optional<ComponentType> type =
        componentType(unsignedMember(accessor, "componentType").value_or(0));
    if (!type)
        return std::nullopt;
    const std::string shape = stringMember(accessor, "type");
    Layout layout;
    layout.type = *type;
    if (shape == "SCALAR") {
        layout.rows = 1;
    } else if (shape.size() == 4 && shape.starts_with("VEC") && shape[3] >= '2' &&
               shape[3] <= '4') {
        layout.rows = static_cast<std::size_t>(shape[3] - '0');
    } else if (shape.size() == 4 && shape.starts_with("MAT") && shape[3] >= '2' &&
               shape[3] <= '4') {
        layout.rows = static_cast<std::size_t>(shape[3] - '0');
        layout.columns = layout.rows;
    } else {
        return std::nullopt;
    }
    layout.column_stride = layout.packedColumn();
    if (layout.columns > 1)
        layout.column_stride = (layout.column_stride + 3) / 4 * 4;
    return layout;
}

// Whether `count` elements of `element` bytes, `stride` apart, lie within `available` bytes from
// `offset` on; no intermediate value can wrap.
bool fits(std::uint64_t count,
          std::uint64_t stride,
          std::uint64_t element,
          std::uint64_t offset,
          std::uint64_t available) {
    if (count == 0)
        return true;
    if (offset > available || element > available - offset)
        return false;
    return count - 1 <= (available - offset - element) / stride;
}

std::string accessorName(std::size_t index) {
    return "accessor " + std::to_string(index);
}

std::uint32_t unsignedAt(const std::byte* from, ComponentType type) {
    std::uint32_t value = 0;
    std::memcpy(&value, from, byteSize(type)); // little-endian, as the file is
    return value;
}

void copyElement(const Layout& layout, const std::byte* from, std::byte* to) {
    for (std::size_t column = 0; column < layout.columns; ++column)
        std::memcpy(to + column * layout.packedColumn(),
                    from + column * layout.column_stride,
                    layout.packedColumn());
}

struct Strided {
    std::span<const std::byte> bytes;
    std::uint64_t offset = 0;
    std::uint64_t stride = 0;

    const std::byte* at(std::uint64_t i) const { return bytes.data() + offset + i * stride; }
};

Result<Strided> denseSource(const AccessorReader& reader,
                            const SourceDocument& document,
                            std::size_t index,
                            const Layout& layout) {
    const json& accessor = listOf(document.json, "accessors")[index];
    const std::uint64_t view_index = *unsignedMember(accessor, "bufferView");
    Result<std::span<const std::byte>> view = reader.view(view_index);
    if (!view)
        return badInput(accessorName(index) + ": " + view.error().message);
    const json& view_json = listOf(document.json, "bufferViews")[view_index];
    const std::uint64_t count = *unsignedMember(accessor, "count");
    Strided source{*view, unsignedMember(accessor, "byteOffset").value_or(0), 0};
    source.stride = unsignedMember(view_json, "byteStride").value_or(0);
    if (source.stride == 0)
        source.stride = layout.fileElement();
    if (source.stride < layout.packedElement())
        return badInput(accessorName(index) + ": byteStride " + std::to_string(source.stride) +
                        " is smaller than an element: re-export the file");
    if (!fits(count, source.stride, layout.packedElement(), source.offset, view->size()))
        return badInput(accessorName(index) + ": " + std::to_string(count) +
                        " elements do not fit buffer view " + std::to_string(view_index) + " (" +
                        std::to_string(view->size()) + " bytes): re-export the file");
    // A padded matrix may lack the padding of its very last column, never a value.
    const std::uint64_t last = source.offset + (count == 0 ? 0 : (count - 1) * source.stride);
    const std::uint64_t needed =
        (layout.columns - 1) * layout.column_stride + layout.packedColumn();
    if (count != 0 && (last > view->size() || needed > view->size() - last))
        return badInput(accessorName(index) + ": its last matrix is cut off: re-export the file");
    return source;
}

Result<void> applySparse(const AccessorReader& reader,
                         const json& sparse,
                         std::size_t index,
                         const Layout& layout,
                         AccessorData& data) {
    const json& indices = sparse["indices"];
    const json& values = sparse["values"];
    const std::uint64_t count = *unsignedMember(sparse, "count");
    const std::string name = accessorName(index) + ", sparse: ";
    const std::optional<ComponentType> type =
        componentType(*unsignedMember(indices, "componentType"));
    if (!type || (*type != ComponentType::UInt8 && *type != ComponentType::UInt16 &&
                  *type != ComponentType::UInt32))
        return badInput(name + "indices are not unsigned integers: re-export the file");
    Result<std::span<const std::byte>> index_view =
        reader.view(*unsignedMember(indices, "bufferView"));
    Result<std::span<const std::byte>> value_view =
        reader.view(*unsignedMember(values, "bufferView"));
    if (!index_view || !value_view)
        return badInput(name + (index_view ? value_view : index_view).error().message);
    const Strided from_indices{
        *index_view, unsignedMember(indices, "byteOffset").value_or(0), byteSize(*type)};
    const Strided from_values{
        *value_view, unsignedMember(values, "byteOffset").value_or(0), layout.fileElement()};
    if (!fits(count,
              from_indices.stride,
              from_indices.stride,
              from_indices.offset,
              index_view->size()) ||
        !fits(
            count, from_values.stride, from_values.stride, from_values.offset, value_view->size()))
        return badInput(name + std::to_string(count) +
                        " elements do not fit their buffer views: re-export the file");
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint32_t target = unsignedAt(from_indices.at(i), *type);
        if (target >= data.count)
            return badInput(name + "index " + std::to_string(target) + " is out of range (" +
                            std::to_string(data.count) + " elements): re-export the file");
        copyElement(layout, from_values.at(i), data.bytes.data() + target * layout.packedElement());
    }
    return {};
}

} // namespace

std::uint64_t AccessorReader::count(std::size_t index) const {
    return unsignedMember(listOf(document_.json, "accessors")[index], "count").value_or(0);
}

Result<std::span<const std::byte>> AccessorReader::view(std::size_t index) const {
    const json& view = listOf(document_.json, "bufferViews")[index];
    const std::string name = "buffer view " + std::to_string(index);
    const std::uint64_t buffer_index = *unsignedMember(view, "buffer");
    const std::vector<std::byte>& buffer = (*document_.buffers)[buffer_index];
    const std::uint64_t offset = unsignedMember(view, "byteOffset").value_or(0);
    const std::uint64_t length = *unsignedMember(view, "byteLength");
    if (offset > buffer.size() || length > buffer.size() - offset)
        return badInput(name + " (" + std::to_string(length) + " bytes from " +
                        std::to_string(offset) + ") leaves buffer " + std::to_string(buffer_index) +
                        " (" + std::to_string(buffer.size()) + " bytes): re-export the file");
    return std::span<const std::byte>(buffer).subspan(offset, length);
}

Result<AccessorPtr> AccessorReader::read(std::size_t index) {
    if (const auto found = cache_.find(index); found != cache_.end())
        return found->second;
    Result<AccessorPtr> data = readUncached(index);
    if (data)
        cache_.emplace(index, *data);
    return data;
}

Result<AccessorData> AccessorReader::format(std::size_t index) const {
    const json& accessor = listOf(document_.json, "accessors")[index];
    const std::optional<Layout> layout = layoutOf(accessor);
    if (!layout)
        return badInput(accessorName(index) + ": component type or type is unknown: "
                                              "re-export the file");
    AccessorData data;
    data.type = layout->type;
    data.components = static_cast<std::uint8_t>(layout->rows * layout->columns);
    data.matrix = layout->columns > 1;
    data.normalized = accessor.value("normalized", false) && layout->type != ComponentType::Float32;
    data.count = *unsignedMember(accessor, "count");
    return data;
}

Result<AccessorPtr> AccessorReader::readUncached(std::size_t index) const {
    const json& accessor = listOf(document_.json, "accessors")[index];
    Result<AccessorData> known = format(index);
    if (!known)
        return tl::make_unexpected(known.error());
    const std::optional<Layout> layout = layoutOf(accessor);
    auto data = std::make_shared<AccessorData>(std::move(*known));
    if (unsignedMember(accessor, "bufferView")) {
        Result<Strided> source = denseSource(*this, document_, index, *layout);
        if (!source)
            return tl::make_unexpected(source.error());
        data->bytes.resize(data->count * layout->packedElement());
        if (source->stride == layout->packedElement() && layout->columns == 1) {
            if (data->count != 0)
                std::memcpy(data->bytes.data(), source->at(0), data->bytes.size());
        } else {
            for (std::uint64_t i = 0; i < data->count; ++i)
                copyElement(
                    *layout, source->at(i), data->bytes.data() + i * layout->packedElement());
        }
    } else if (data->count > kMaxZeroElements) {
        return badInput(accessorName(index) + ": " + std::to_string(data->count) +
                        " elements without a buffer view: re-export the file");
    } else {
        data->bytes.resize(data->count * layout->packedElement());
    }
    if (const json* sparse = member(accessor, "sparse"))
        if (Result<void> applied = applySparse(*this, *sparse, index, *layout, *data); !applied)
            return tl::make_unexpected(applied.error());
    return data;
}

} // namespace lodestone
