#include "bench/parts.h"

#include <cctype>
#include <fstream>

namespace lodestone::bench {

std::filesystem::path Parts::fileOf(const std::string& name) const {
    std::string file;
    for (const char letter : name)
        if (std::isalnum(static_cast<unsigned char>(letter)) != 0)
            file += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
        else if (!file.empty() && file.back() != '-')
            file += '-';
    return folder_ / (file + ".json");
}

std::optional<Part> Parts::find(const std::string& name, const PartOrigin& origin) const {
    if (folder_.empty() || origin.commit.empty())
        return std::nullopt;
    std::ifstream file(fileOf(name));
    const nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
    if (!json.is_object() || json.value("name", "") != name ||
        json.value("commit", "") != origin.commit || json.value("how", "") != origin.how ||
        !json.contains("content"))
        return std::nullopt;
    return Part{name, {origin.commit, origin.how, json.value("seconds", 0.0)}, json.at("content")};
}

Result<void> Parts::keep(const Part& part) const {
    if (folder_.empty())
        return {};
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    // A file is there whole or not at all.
    const std::filesystem::path path = fileOf(part.name);
    const std::filesystem::path half = path.string() + ".half";
    const nlohmann::json json{{"name", part.name},
                              {"commit", part.origin.commit},
                              {"how", part.origin.how},
                              {"seconds", part.origin.seconds},
                              {"content", part.content}};
    std::ofstream file(half);
    file << json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
    file.close();
    if (file)
        std::filesystem::rename(half, path, error);
    if (!file || error)
        return fail(ErrorKind::Failed, path.string() + ": cannot be written");
    return {};
}

} // namespace lodestone::bench
