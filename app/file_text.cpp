#include "app/file_text.h"

#include <fmt/core.h>
#include <fstream>
#include <unistd.h>

namespace lodestone {

Result<void> writeFileText(const std::filesystem::path& path, std::string_view text) {
    std::filesystem::path temporary = path;
    temporary += fmt::format(".{}.tmp", getpid());
    std::error_code error;
    {
        std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
        stream << text << std::flush;
        if (!stream) {
            stream.close();
            std::filesystem::remove(temporary, error);
            return fail(ErrorKind::Failed,
                        fmt::format("{}: cannot be written; check folder, rights and free space",
                                    path.string()));
        }
    }
    std::filesystem::rename(temporary, path, error);
    if (!error)
        return {};
    const std::string reason = error.message();
    std::filesystem::remove(temporary, error);
    return fail(
        ErrorKind::Failed,
        fmt::format("{}: cannot be replaced ({}); choose another name", path.string(), reason));
}

} // namespace lodestone
