#include "scene/gltf/resources.h"

#include "scene/gltf/accessor_reader.h"
#include "scene/gltf/uri.h"

#include <cstring>

namespace lodestone {

using nlohmann::json;

namespace {

bool isMeshoptFallback(const json& buffer) {
    const json* words = extension(buffer, "EXT_meshopt_compression");
    const json* fallback = words == nullptr ? nullptr : member(*words, "fallback");
    return fallback != nullptr && fallback->is_boolean() && fallback->get<bool>();
}

// Bytes behind a URI, by reading a data URI or a file beside the model.
Result<std::vector<std::byte>> readUri(const ReadContext& context, const std::string& uri) {
    if (isDataUri(uri)) {
        Result<DataUri> data = decodeDataUri(uri);
        if (!data)
            return tl::make_unexpected(data.error());
        return std::move(data->bytes);
    }
    Result<std::filesystem::path> path = resolveBeside(context.document.folder, uri);
    if (!path)
        return tl::make_unexpected(path.error());
    Result<std::vector<std::byte>> bytes = readFileBytes(*path);
    if (bytes)
        context.scene.file_bytes += bytes->size();
    return bytes;
}

Result<std::vector<std::byte>>
readBuffer(const ReadContext& context, const json& buffer, std::size_t index, GltfContainer& from) {
    const std::uint64_t length = *unsignedMember(buffer, "byteLength");
    std::vector<std::byte> bytes;
    if (buffer.contains("uri")) {
        Result<std::vector<std::byte>> read = readUri(context, buffer["uri"].get<std::string>());
        if (!read)
            return read;
        bytes = std::move(*read);
    } else if (index == 0 && from.has_binary) {
        bytes = std::move(from.binary);
    } else if (isMeshoptFallback(buffer)) {
        return bytes;
    } else {
        return badInput("has neither a uri nor a GLB chunk: re-export the file");
    }
    if (bytes.size() < length)
        return badInput("has " + std::to_string(bytes.size()) + " bytes, byteLength says " +
                        std::to_string(length) + ": copy or re-export the file");
    bytes.resize(length);
    return bytes;
}

// Media type by the first bytes; empty if unknown.
std::string sniffMimeType(std::span<const std::byte> bytes) {
    const auto starts = [&](std::string_view head, std::size_t at) {
        return bytes.size() >= at + head.size() &&
               std::memcmp(bytes.data() + at, head.data(), head.size()) == 0;
    };
    if (starts("\x89PNG", 0))
        return "image/png";
    if (starts("\xFF\xD8\xFF", 0))
        return "image/jpeg";
    if (starts("\xABKTX 20", 0))
        return "image/ktx2";
    if (starts("RIFF", 0) && starts("WEBP", 8))
        return "image/webp";
    return {};
}

// Bytes of an image; nothing and a note if they are missing.
Result<std::optional<std::vector<std::byte>>>
imageBytes(const ReadContext& context, const json& source, const std::string& name) {
    if (const auto view = unsignedMember(source, "bufferView")) {
        const AccessorReader reader(context.document);
        Result<std::span<const std::byte>> bytes = reader.view(*view);
        if (!bytes)
            return badInput(bytes.error().message);
        return std::vector<std::byte>(bytes->begin(), bytes->end());
    }
    const std::string uri = stringMember(source, "uri");
    if (uri.empty()) {
        context.note(name + " has neither a uri nor a buffer view and is not shown");
        return std::nullopt;
    }
    if (!isDataUri(uri)) {
        Result<std::filesystem::path> path = resolveBeside(context.document.folder, uri);
        if (!path)
            return tl::make_unexpected(path.error());
        std::error_code error;
        if (!std::filesystem::is_regular_file(*path, error)) {
            context.note(name + ": file " + path->filename().string() +
                         " is missing, its surfaces are shown without it");
            return std::nullopt;
        }
    }
    Result<std::vector<std::byte>> bytes = readUri(context, uri);
    if (!bytes)
        return tl::make_unexpected(bytes.error());
    return std::move(*bytes);
}

} // namespace

Result<void> readBuffers(const ReadContext& context, GltfContainer& container) {
    const json& buffers = listOf(context.document.json, "buffers");
    for (std::size_t b = 0; b < buffers.size(); ++b) {
        Result<std::vector<std::byte>> bytes = readBuffer(context, buffers[b], b, container);
        if (!bytes)
            return context.bad("buffer " + std::to_string(b) + ": " + bytes.error().message);
        context.document.buffers->push_back(std::move(*bytes));
    }
    return {};
}

Result<void> readImages(const ReadContext& context) {
    const json& images = listOf(context.document.json, "images");
    for (std::size_t i = 0; i < images.size(); ++i) {
        const json& source = images[i];
        Image image;
        image.name = stringMember(source, "name");
        image.mime_type = stringMember(source, "mimeType");
        const std::string uri = stringMember(source, "uri");
        if (!isDataUri(uri))
            image.uri = uri;
        const std::string name = label("image", i, image.name);
        Result<std::optional<std::vector<std::byte>>> bytes = imageBytes(context, source, name);
        if (!bytes)
            return context.bad(name + ": " + bytes.error().message);
        if (*bytes) {
            if (image.mime_type.empty())
                image.mime_type = sniffMimeType(**bytes);
            image.bytes = std::make_shared<const std::vector<std::byte>>(std::move(**bytes));
        }
        context.scene.images.push_back(std::move(image));
    }
    return {};
}

} // namespace lodestone
