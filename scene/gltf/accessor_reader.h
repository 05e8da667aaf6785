#pragma once
#include "scene/gltf/read_context.h"

#include <unordered_map>

namespace lodestone {

// An accessor's elements, tightly packed: no stride, sparse values in place, matrix columns without
// padding.
struct AccessorData {
    ComponentType type = ComponentType::Float32;
    std::uint8_t components = 1; // 1..4, 9, 16 (MAT2 has 4, like VEC4)
    bool matrix = false;
    bool normalized = false;
    std::uint64_t count = 0;
    std::vector<std::byte> bytes; // [count * components * byteSize(type)]
};

using AccessorPtr = std::shared_ptr<const AccessorData>;

// Reads accessors of a validated document, each once. Every count, offset and stride is held
// against the bytes that are there before anything is allocated; an accessor without a buffer view
// (zeros) has at most 16,777,216 elements. Not thread-safe.
class AccessorReader {
public:
    explicit AccessorReader(const SourceDocument& document) : document_(document) {}

    // index in range. Errors: BadInput, message without file name.
    Result<AccessorPtr> read(std::size_t index);

    // Type, components and count as the file says, no bytes. Errors: BadInput as above.
    Result<AccessorData> format(std::size_t index) const;

    // Bytes of a buffer view. Errors: BadInput if it leaves its buffer.
    Result<std::span<const std::byte>> view(std::size_t index) const;

    std::uint64_t count(std::size_t index) const; // as the file says, unchecked

    const SourceDocument& document() const { return document_; }

private:
    Result<AccessorPtr> readUncached(std::size_t index) const;

    const SourceDocument& document_;
    std::unordered_map<std::size_t, AccessorPtr> cache_;
};

} // namespace lodestone
