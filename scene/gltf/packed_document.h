#pragma once
// An export in memory, ready to be packed by EXT_meshopt_compression or KHR_draco_mesh_compression:
// document and binary of one buffer, of which the views from `first_view` on hold what an export
// wrote of geometry and instances; those before are carried and stay as they are.
#include "scene/gltf/source_document.h"

#include <span>

namespace lodestone {

struct PackedDocument { // NOLINT(bugprone-exception-escape): json moves without throwing
    nlohmann::json json;
    std::vector<std::byte> binary;
    std::uint32_t first_view = 0;
    std::uint64_t first_byte = 0;        // of the view first_view
    double diagonal = 0.0;               // of the scene: what precision is measured by
    std::uint64_t row_bytes = 0;         // of the binary, for instance rows, once packed
    std::uint64_t dropped_triangles = 0; // that the packed form cannot hold: two corners are one
};

// What an accessor of the export is used for.
struct AccessorUse {
    enum class Kind : std::uint8_t { None, Vertex, Triangles, Indices, Row };

    Kind kind = Kind::None;     // None: not in a view of the export
    std::string semantic;       // of Vertex and Row
    std::uint32_t node = kNone; // of Row
    std::uint32_t users = 0;    // primitives and nodes that refer to it
};

std::vector<AccessorUse> accessorUses(const PackedDocument& document); // [accessors]

// Elements of an accessor as they lie in the binary, padding to 4 bytes included for vertices.
struct StridedElements {
    std::size_t count = 0;
    std::size_t stride = 0;
    std::span<const std::byte> bytes; // [count * stride]
};

StridedElements elementsOf(const PackedDocument& document, std::size_t accessor);

// 0 for the usual floats read as they are, otherwise decoded by glTF's rule. [count * components]
std::vector<float> floatsOf(const PackedDocument& document, std::size_t accessor);
std::vector<std::uint32_t> indicesOf(const PackedDocument& document, std::size_t accessor);
std::size_t componentsOf(const nlohmann::json& accessor);

// Most that each node and its parents stretch a length. [nodes]
std::vector<double> nodeStretches(const nlohmann::json& document);
// The largest component of the SCALE of a node's rows; 1 if it has none.
double largestRowScale(const PackedDocument& document, std::size_t node);

void padTo4(std::vector<std::byte>& bytes);

// Adds an extension to the lists of those used and required.
void requireExtension(nlohmann::json& document, const char* name);

} // namespace lodestone
