#pragma once
// What was measured, part by part in files: a run that was broken off goes on where it stopped, and
// parts that were measured apart make one report.
#include "scene/result.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace lodestone::bench {

// How a part came about. A kept part counts again only if commit and `how` are the same.
struct PartOrigin {
    std::string commit;   // empty: the program is of no one commit, nothing counts again
    std::string how;      // "5 rounds"
    double seconds = 0.0; // wall time it took
};

struct Part {
    std::string name; // unique: "peers: Maple"
    PartOrigin origin;
    nlohmann::json content;
};

class Parts {
public:
    // folder: made when the first part is kept; empty: nothing is kept.
    explicit Parts(std::filesystem::path folder) : folder_(std::move(folder)) {}

    // The part as it was kept; none if there is none of that origin, or its file is damaged.
    std::optional<Part> find(const std::string& name, const PartOrigin& origin) const;
    // Errors: Failed, naming the file.
    Result<void> keep(const Part& part) const;

private:
    std::filesystem::path fileOf(const std::string& name) const;
    std::filesystem::path folder_;
};

} // namespace lodestone::bench
