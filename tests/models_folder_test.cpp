#include "tests/models_folder.h"

using lodestone::tests::ModelsTest;

namespace {

class ModelsFolder : public ModelsTest {};

} // namespace

TEST_F(ModelsFolder, HoldsEveryClassOfModelTheSweepsRunOver) {
    for (const char* name : {"instanced", "meshes", "features", "bad"})
        EXPECT_FALSE(std::filesystem::is_empty(lodestone::tests::modelsFolder() / name)) << name;
}
