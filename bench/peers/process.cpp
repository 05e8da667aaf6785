#include "bench/peers/process.h"

#include <array>
#include <atomic>
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace lodestone::bench {

namespace {

double secondsOf(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

std::string readToEnd(int end) {
    std::string text;
    std::array<char, 4096> block{};
    for (ssize_t got = 0; (got = read(end, block.data(), block.size())) > 0;)
        text.append(block.data(), static_cast<std::size_t>(got));
    return text;
}

// What posix_spawn is to do with the streams of the child.
class Streams {
public:
    explicit Streams(int out) {
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_adddup2(&actions_, out, STDOUT_FILENO);
        posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    }

    ~Streams() { posix_spawn_file_actions_destroy(&actions_); }

    Streams(const Streams&) = delete;
    Streams& operator=(const Streams&) = delete;

    const posix_spawn_file_actions_t* get() const { return &actions_; }

private:
    posix_spawn_file_actions_t actions_{};
};

} // namespace

Result<Ran> runProgram(const std::vector<std::string>& arguments) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0)
        return fail(ErrorKind::Failed, arguments.front() + ": no pipe for its output");
    std::vector<std::string> words = arguments;
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words)
        pointers.push_back(word.data());
    pointers.push_back(nullptr);
    pid_t child = 0;
    const Streams streams(ends[1]);
    const int error =
        posix_spawnp(&child, pointers.front(), streams.get(), nullptr, pointers.data(), environ);
    close(ends[1]);
    Ran ran;
    if (error == 0)
        ran.output = readToEnd(ends[0]);
    close(ends[0]);
    if (error != 0)
        return fail(ErrorKind::Failed, arguments.front() + ": cannot be started");
    int status = 0;
    rusage usage{};
    if (wait4(child, &status, 0, &usage) != child || status != 0) {
        std::string line;
        for (const std::string& word : arguments)
            line += (line.empty() ? "" : " ") + word;
        return fail(ErrorKind::Failed, "failed: " + line);
    }
    ran.seconds = secondsOf(usage.ru_utime) + secondsOf(usage.ru_stime);
    return ran;
}

ScratchFolder::ScratchFolder() {
    static std::atomic<int> made{0};
    path_ = std::filesystem::temp_directory_path() /
            ("lodestone-bench-" + std::to_string(getpid()) + "-" + std::to_string(made++));
    std::error_code ignored; // what cannot be made shows when it is written to
    std::filesystem::create_directories(path_, ignored);
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

} // namespace lodestone::bench
