#pragma once
#include <filesystem>

namespace lodestone::tests {

// The folder of the sources that the tests were built from.
std::filesystem::path sourceFolder();

} // namespace lodestone::tests
