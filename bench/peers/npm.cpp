#include "bench/peers/npm.h"

#include "bench/peers/process.h"

#include <fstream>
#include <nlohmann/json.hpp>

namespace lodestone::bench {

Result<std::string> npmVersion(const std::string& npm, const std::string& module) {
    std::ifstream file(npm + "/" + module + "/package.json");
    const nlohmann::json package = nlohmann::json::parse(file, nullptr, false);
    if (!package.is_object() || !package.contains("version") || !package["version"].is_string())
        return fail(ErrorKind::Failed, "not installed: bench/run.sh installs it");
    if (!runProgram({"node", "--version"}))
        return fail(ErrorKind::Failed, "node is not installed");
    return package["version"].get<std::string>();
}

} // namespace lodestone::bench
