#pragma once
#include "scene/gltf/read_context.h"

namespace lodestone {

// Decompresses every buffer view under EXT_meshopt_compression into its fallback buffer and forgets
// the extension, so that what comes after meets an ordinary document. Views whose uncompressed
// bytes are in the file keep those. readBuffers() comes before.
// Errors: BadInput naming the view. No allocation beyond 64 times the compressed bytes.
Result<void> decompressMeshopt(const ReadContext& context);

} // namespace lodestone
