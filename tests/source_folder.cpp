#include "tests/source_folder.h"

namespace lodestone::tests {

std::filesystem::path sourceFolder() {
    return LODESTONE_SOURCE_DIR;
}

} // namespace lodestone::tests
