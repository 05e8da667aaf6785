#include "scene/assimp/assimp_import.h"

#include "scene/assimp/folder_io.h"
#include "scene/assimp/precheck.h"
#include "scene/assimp/scene_convert.h"

#include <algorithm>
#include <assimp/Importer.hpp>
#include <assimp/ProgressHandler.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <cctype>
#include <fstream>
#include <stdexcept>

#ifdef __ELF__
namespace Assimp {

// Packaged builds of assimp end the process where a damaged file breaks an assumption. This
// definition takes the place of the library's own, so that such a file is an error like others.
// The declaration is the library's.
[[noreturn]] void aiAssertViolation(const char* expression, const char* /*file*/, int /*line*/);

void aiAssertViolation(const char* expression, const char* /*file*/, int /*line*/) {
    throw std::runtime_error(std::string("contradiction: ") + expression);
}

} // namespace Assimp
#endif

namespace lodestone {

namespace {

std::string extensionOf(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char letter) {
        return static_cast<char>(std::tolower(letter));
    });
    return extension;
}

class Progress : public Assimp::ProgressHandler {
public:
    explicit Progress(const JobContext& job) : job_(job) {}

    bool Update(float fraction) override {
        job_.report(0.7 * std::clamp(static_cast<double>(fraction), 0.0, 1.0));
        return !job_.stopRequested();
    }

private:
    const JobContext& job_;
};

void configure(Assimp::Importer& importer) {
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
}

// Words of a library or of a file, fit for one line.
std::string oneLine(std::string text) {
    std::ranges::replace_if(
        text, [](unsigned char letter) { return std::iscntrl(letter) != 0; }, ' ');
    while (!text.empty() && (text.back() == ' ' || text.back() == '.'))
        text.pop_back();
    return text.substr(0, 300);
}

Result<void> precheckFile(const std::filesystem::path& path) {
    const std::string name = path.filename().string();
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    std::ifstream stream(path, std::ios::binary);
    if (error || !stream)
        return badInput(name + ": cannot be opened; check the path and its permissions");
    std::string bytes(size, '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(stream.gcount()) != size)
        return badInput(name + ": cannot be read to its end; check the disk");
    if (const Result<void> ok = precheck(extensionOf(path), bytes); !ok)
        return badInput(name + ": " + oneLine(ok.error().message));
    return {};
}

Result<ScenePtr> readScene(const std::filesystem::path& path, const JobContext& job) {
    const std::string name = path.filename().string();
    Assimp::Importer importer; // owns what follows
    auto* const io = new FolderIo(path);
    importer.SetIOHandler(io);
    importer.SetProgressHandler(new Progress(job));
    configure(importer);
    const aiScene* const scene = importer.ReadFile(path.string(), aiProcess_Triangulate);
    if (job.stopRequested())
        return cancelled();
    if (scene == nullptr)
        return badInput(name + ": cannot be read (" + oneLine(importer.GetErrorString()) +
                        "); the file is damaged or of another format, export it again");
    return convertScene(*scene, {path, extensionOf(path), io->openedBytes()}, job);
}

} // namespace

Result<ScenePtr> importWithAssimp(const std::filesystem::path& path, const JobContext& job) {
    const std::string name = path.filename().string();
    try {
        if (const Result<void> ok = precheckFile(path); !ok)
            return tl::unexpected(ok.error());
        return readScene(path, job);
    } catch (const std::bad_alloc&) {
        return badInput(name + ": out of memory while reading; the file is damaged or too large");
    } catch (const std::exception& exception) {
        return badInput(name + ": cannot be read (" + oneLine(exception.what()) +
                        "); the file is damaged, export it again");
    }
}

} // namespace lodestone
