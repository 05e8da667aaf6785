#pragma once
// The list of recent files: one path a line, newest first.
#include <filesystem>
#include <vector>

namespace lodestone {

std::vector<std::filesystem::path> readRecent(const std::filesystem::path& list_file);
// Puts `opened` first, once. Keeps at most ten.
void addRecent(std::vector<std::filesystem::path>& recent, const std::filesystem::path& opened);
// Atomic; makes the folder. Returns false if it could not be written.
bool writeRecent(const std::filesystem::path& list_file,
                 const std::vector<std::filesystem::path>& recent);

} // namespace lodestone
