#pragma once
#include "scene/gltf/read_context.h"

namespace lodestone {

// Fills Scene::materials from a validated document: core material, KHR_materials_unlit,
// KHR_texture_transform, KHR_texture_basisu, EXT_texture_webp (the plain source is preferred where
// a texture has both). Everything else stays in the document alone. Errors: BadInput.
Result<void> readMaterials(const ReadContext& context);

} // namespace lodestone
