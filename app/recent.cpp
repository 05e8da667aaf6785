#include "app/recent.h"

#include "app/file_text.h"
#include "app/session.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

namespace lodestone {

namespace {

constexpr std::size_t kMaximumRecent = 10;

std::filesystem::path environmentPath(const char* name) {
    const char* value = std::getenv(name);
    return value ? std::filesystem::path(value) : std::filesystem::path();
}

} // namespace

std::vector<std::filesystem::path> readRecent(const std::filesystem::path& list_file) {
    std::vector<std::filesystem::path> recent;
    std::ifstream stream(list_file);
    std::string line;
    while (recent.size() < kMaximumRecent && std::getline(stream, line))
        if (!line.empty())
            recent.emplace_back(line);
    return recent;
}

void addRecent(std::vector<std::filesystem::path>& recent, const std::filesystem::path& opened) {
    std::error_code error;
    std::filesystem::path absolute = std::filesystem::absolute(opened, error).lexically_normal();
    if (error)
        absolute = opened;
    std::erase(recent, absolute);
    recent.insert(recent.begin(), absolute);
    if (recent.size() > kMaximumRecent)
        recent.resize(kMaximumRecent);
}

bool writeRecent(const std::filesystem::path& list_file,
                 const std::vector<std::filesystem::path>& recent) {
    std::error_code error;
    std::filesystem::create_directories(list_file.parent_path(), error);
    std::string text;
    for (const std::filesystem::path& path : recent)
        text += path.string() + '\n';
    return writeFileText(list_file, text).has_value();
}

std::filesystem::path defaultRecentFile() {
    if (const std::filesystem::path config = environmentPath("XDG_CONFIG_HOME"); !config.empty())
        return config / "lodestone" / "recent";
    const std::filesystem::path home = environmentPath("HOME");
    return home.empty() ? home : home / ".config" / "lodestone" / "recent";
}

std::filesystem::path uiLogFileFromEnvironment() {
    return environmentPath("LODESTONE_UI_LOG");
}

} // namespace lodestone
