#pragma once
#include "scene/gltf/container.h"
#include "scene/gltf/read_context.h"

namespace lodestone {

// Fills SourceDocument::buffers from data URIs, the GLB's chunk and files beside the model; adds
// files' sizes to Scene::file_bytes. A buffer that only stands in for compressed data stays empty.
// Errors: BadInput for a missing or too short buffer, for a path out of the folder.
Result<void> readBuffers(const ReadContext& context, GltfContainer& container);

// Fills Scene::images with encoded bytes. A missing image is a note, not an error.
// readBuffers() comes before. Errors: BadInput for a path out of the folder.
Result<void> readImages(const ReadContext& context);

} // namespace lodestone
