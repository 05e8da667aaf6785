#include "scene/gltf/meshopt_reader.h"

#include <algorithm>
#include <limits>
#include <meshoptimizer.h>

namespace lodestone {

using nlohmann::json;

namespace {

constexpr const char* kExtension = "EXT_meshopt_compression";
// The densest code spends two bits on sixteen equal bytes.
constexpr std::uint64_t kMostBytesPerByte = 64;

// A compressed view, every number checked.
struct CompressedView {
    std::span<const std::byte> source;
    std::span<std::byte> target;
    std::size_t count = 0;
    std::size_t stride = 0;
    std::string mode;
    std::string filter;
};

// length bytes from offset on, or nothing if they leave the buffer.
template <class Byte>
std::optional<std::span<Byte>>
part(std::span<Byte> buffer, std::uint64_t offset, std::uint64_t length) {
    if (offset > buffer.size() || length > buffer.size() - offset)
        return std::nullopt;
    return buffer.subspan(offset, length);
}

bool strideFits(const CompressedView& view) {
    if (view.mode == "ATTRIBUTES")
        return view.stride % 4 == 0 && view.stride > 0 && view.stride <= 256;
    return (view.mode == "TRIANGLES" || view.mode == "INDICES") &&
           (view.stride == 2 || view.stride == 4) &&
           (view.mode == "INDICES" || view.count % 3 == 0);
}

bool filterFits(const CompressedView& view) {
    if (view.filter.empty() || view.filter == "NONE")
        return true;
    if (view.mode != "ATTRIBUTES")
        return false;
    if (view.filter == "OCTAHEDRAL")
        return view.stride == 4 || view.stride == 8;
    return view.filter == "QUATERNION" ? view.stride == 8 : view.filter == "EXPONENTIAL";
}

bool decode(const CompressedView& view) {
    const auto* from = reinterpret_cast<const unsigned char*>(view.source.data());
    std::byte* to = view.target.data();
    if (view.mode == "TRIANGLES")
        return meshopt_decodeIndexBuffer(to, view.count, view.stride, from, view.source.size()) ==
               0;
    if (view.mode == "INDICES")
        return meshopt_decodeIndexSequence(to, view.count, view.stride, from, view.source.size()) ==
               0;
    if (meshopt_decodeVertexBuffer(to, view.count, view.stride, from, view.source.size()) != 0)
        return false;
    // The library filters blocks of four elements and their rest on its own.
    if (view.filter == "OCTAHEDRAL")
        meshopt_decodeFilterOct(to, view.count, view.stride);
    else if (view.filter == "QUATERNION")
        meshopt_decodeFilterQuat(to, view.count, view.stride);
    else if (view.filter == "EXPONENTIAL")
        meshopt_decodeFilterExp(to, view.count, view.stride);
    return true;
}

class Decompressor {
public:
    explicit Decompressor(const ReadContext& context)
        : document_(context.document.json), buffers_(*context.document.buffers),
          filled_(buffers_.size(), false) {}

    // Buffers without bytes of their own get room, as far as the compressed bytes warrant it.
    Result<void> makeRoom() {
        std::uint64_t compressed = 0;
        for (const json& view : listOf(document_, "bufferViews"))
            if (const json* words = extension(view, kExtension))
                compressed += unsignedMember(*words, "byteLength").value_or(0);
        const std::uint64_t most =
            compressed > std::numeric_limits<std::uint64_t>::max() / kMostBytesPerByte
                ? 0
                : compressed * kMostBytesPerByte;
        const json& list = listOf(document_, "buffers");
        for (std::size_t b = 0; b < list.size(); ++b) {
            const std::uint64_t length = unsignedMember(list[b], "byteLength").value_or(0);
            if (!buffers_[b].empty() || length == 0)
                continue;
            if (length > most)
                return badInput("buffer " + std::to_string(b) + ": " + std::to_string(length) +
                                " bytes cannot come out of " + std::to_string(compressed) +
                                " compressed ones: re-export the file");
            buffers_[b].resize(length);
            filled_[b] = true;
        }
        return {};
    }

    Result<void> decompress(const json& view, std::size_t index) {
        const json* words = extension(view, kExtension);
        const std::uint64_t buffer = *unsignedMember(view, "buffer");
        if (words == nullptr || !filled_[buffer])
            return {};
        const auto wrong = [&](const std::string& fault) {
            return badInput("buffer view " + std::to_string(index) + ": " + kExtension + ": " +
                            fault + ": re-export the file");
        };
        CompressedView from;
        const std::uint64_t source = unsignedMember(*words, "buffer").value_or(buffers_.size());
        if (source >= buffers_.size() || filled_[source])
            return wrong("its buffer does not hold compressed bytes");
        const auto bytes = part(std::span<const std::byte>(buffers_[source]),
                                unsignedMember(*words, "byteOffset").value_or(0),
                                unsignedMember(*words, "byteLength").value_or(0));
        const auto target = part(std::span(buffers_[buffer]),
                                 unsignedMember(view, "byteOffset").value_or(0),
                                 *unsignedMember(view, "byteLength"));
        if (!bytes || !target)
            return wrong("it leaves its buffer");
        from.source = *bytes;
        from.target = *target;
        from.count = unsignedMember(*words, "count").value_or(0);
        from.stride = unsignedMember(*words, "byteStride").value_or(0);
        from.mode = stringMember(*words, "mode");
        from.filter = stringMember(*words, "filter");
        if (!strideFits(from) || !filterFits(from))
            return wrong("mode, filter, stride and count do not go together");
        if (from.count > from.target.size() / from.stride)
            return wrong(std::to_string(from.count) + " elements do not fit the view");
        if (!decode(from))
            return wrong("the data are damaged or of a newer version");
        return {};
    }

private:
    const json& document_;
    std::vector<std::vector<std::byte>>& buffers_;
    std::vector<bool> filled_; // [buffers] ours to fill
};

void forget(json& document) {
    for (const char* list : {"buffers", "bufferViews"})
        if (document.contains(list))
            for (json& element : document[list])
                if (extension(element, kExtension) != nullptr)
                    element["extensions"].erase(kExtension);
}

} // namespace

Result<void> decompressMeshopt(const ReadContext& context) {
    json& document = context.document.json;
    const json& views = listOf(document, "bufferViews");
    if (std::ranges::none_of(
            views, [](const json& view) { return extension(view, kExtension) != nullptr; }))
        return {};
    Decompressor decompressor(context);
    Result<void> done = decompressor.makeRoom();
    for (std::size_t v = 0; v < views.size() && done; ++v) {
        if (context.job.stopRequested())
            return cancelled();
        done = decompressor.decompress(views[v], v);
    }
    if (!done)
        return context.bad(done.error().message);
    forget(document);
    return {};
}

} // namespace lodestone
