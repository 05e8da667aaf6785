#pragma once
#include "scene/result.h"

#include <filesystem>

namespace lodestone {

// Writes a text beside the path and renames it: an existing file survives any failure.
// Errors: Failed, naming the file.
Result<void> writeFileText(const std::filesystem::path& path, std::string_view text);

} // namespace lodestone
