#pragma once
#include "scene/result.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace lodestone {

struct DataUri {
    std::string mime_type; // may be empty
    std::vector<std::byte> bytes;
};

bool isDataUri(std::string_view uri);

// Any media type, base64 or percent-encoded. Errors: BadInput (message without file name).
Result<DataUri> decodeDataUri(std::string_view uri);

// The file a relative reference names, which must lie in folder or below once "..", "%2e" and
// symbolic links are resolved. It need not exist. Errors: BadInput (message without file name).
Result<std::filesystem::path> resolveBeside(const std::filesystem::path& folder,
                                            std::string_view uri);

} // namespace lodestone
