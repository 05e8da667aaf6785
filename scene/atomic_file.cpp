#include "scene/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lodestone {

namespace fs = std::filesystem;

namespace {

std::string remedyFor(int error) {
    switch (error) {
    case ENOENT:
        return "; create the folder first";
    case EACCES:
    case EPERM:
    case EROFS:
        return "; choose a folder that can be written to";
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
        return "; free some space, the old file is untouched";
    default:
        return "";
    }
}

tl::unexpected<Error> failureOf(const fs::path& path, const char* action, int error) {
    return fail(ErrorKind::Failed,
                path.string() + ": cannot " + action + ": " + std::strerror(error) +
                    remedyFor(error));
}

} // namespace

Result<AtomicFile> AtomicFile::create(const fs::path& path) {
    static std::atomic<unsigned int> counter{0};
    std::error_code error;
    // A link stays a link: what it points to is replaced.
    const fs::path target = fs::is_symlink(path, error) ? fs::weakly_canonical(path, error) : path;
    const fs::file_status status = fs::status(target, error);
    if (fs::exists(status) && !fs::is_regular_file(status))
        return fail(ErrorKind::Failed,
                    path.string() + ": cannot write: not a regular file; choose another name");
    const std::string name =
        ".lodestone-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp";
    const fs::path temporary = target.parent_path() / name;
    const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0)
        return failureOf(path, "write", errno);
    if (fs::exists(status))
        fs::permissions(temporary, status.permissions(), error);
    return AtomicFile(target, temporary, descriptor);
}

AtomicFile::AtomicFile(fs::path path, fs::path temporary, int descriptor)
    : path_(std::move(path)), temporary_(std::move(temporary)), descriptor_(descriptor) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)), temporary_(std::move(other.temporary_)),
      descriptor_(std::exchange(other.descriptor_, -1)) {
    other.temporary_.clear();
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0)
        ::close(descriptor_);
    if (!temporary_.empty())
        ::unlink(temporary_.c_str());
}

tl::unexpected<Error> AtomicFile::failure(const char* action) const {
    return failureOf(path_, action, errno);
}

Result<void> AtomicFile::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            return failure("write");
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return {};
}

Result<void> AtomicFile::sync() {
    if (::fsync(descriptor_) != 0)
        return failure("write");
    if (::close(std::exchange(descriptor_, -1)) != 0)
        return failure("write");
    return {};
}

Result<void> AtomicFile::commit() {
    if (descriptor_ >= 0)
        if (Result<void> synced = sync(); !synced)
            return synced;
    if (::rename(temporary_.c_str(), path_.c_str()) != 0)
        return failure("replace the file");
    temporary_.clear();
    return {};
}

} // namespace lodestone
