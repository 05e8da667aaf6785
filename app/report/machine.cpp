#include "app/report/machine.h"

#include <array>
#include <ctime>
#include <fstream>
#include <string_view>
#include <sys/utsname.h>
#include <thread>

namespace lodestone {

namespace {

// What follows the key and its separator in the first line that begins with it.
std::string valueOf(const char* file, std::string_view key, char separator) {
    std::ifstream stream(file);
    std::string line;
    while (std::getline(stream, line)) {
        if (!line.starts_with(key))
            continue;
        const std::size_t at = line.find(separator);
        if (at == std::string::npos)
            continue;
        const std::size_t begin = line.find_first_not_of(" \t\"", at + 1);
        const std::size_t end = line.find_last_not_of(" \t\"");
        return begin == std::string::npos ? std::string() : line.substr(begin, end - begin + 1);
    }
    return {};
}

std::string today() {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    std::array<char, 16> text{};
    const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%d", &local);
    return {text.data(), length};
}

} // namespace

MachineFacts thisMachine() {
    MachineFacts facts;
    utsname names{};
    const bool named = uname(&names) == 0;
    facts.processor = valueOf("/proc/cpuinfo", "model name", ':');
    if (facts.processor.empty() && named)
        facts.processor = names.machine;
    facts.threads = std::thread::hardware_concurrency();
    if (named)
        facts.system = std::string(names.sysname) + " " + names.release;
    if (const std::string pretty = valueOf("/etc/os-release", "PRETTY_NAME", '='); !pretty.empty())
        facts.system += (facts.system.empty() ? "" : ", ") + pretty;
    facts.program = "Lodestone " LODESTONE_VERSION;
    facts.date = today();
    return facts;
}

} // namespace lodestone
