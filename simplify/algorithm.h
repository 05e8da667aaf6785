#pragma once
// The one table of algorithms. The command line's help, the inspector's sliders, the compare table
// and the tests are driven by it: adding an algorithm touches one folder and one row.
#include "scene/job_context.h"
#include "scene/result.h"
#include "simplify/lod_source.h"

#include <map>
#include <string>

namespace lodestone {

struct ParameterInfo {
    enum class Kind : std::uint8_t { Number, Integer, Toggle, Choice };

    std::string_view id;    // --param NAME
    std::string_view label; // inspector
    std::string_view unit;  // "", "% of the diagonal", ...
    std::string_view tooltip;
    Kind kind = Kind::Number;
    double minimum = 0.0;
    double maximum = 1.0;
    double fallback = 0.0;                 // default
    std::vector<std::string_view> choices; // Kind::Choice: value is the index
    bool logarithmic = false;              // slider scale
    bool of_textures = false; // of their transfer: the LODs are the same whatever its value
    std::string_view needs;   // means nothing while that parameter is 0; empty: always counts
};

using ParameterValues = std::map<std::string, double, std::less<>>; // missing: default

enum class Family : std::uint8_t {
    EdgeCollapse, // follows a slider in the same frame
    OneShot,      // re-run per change
};

struct Algorithm {
    std::string_view id;         // "ias"
    std::string_view name;       // "Instance-aware (IAS)"
    std::string_view short_name; // lane header: "IAS"
    std::string_view paper;      // author, year
    std::string_view summary;    // one sentence
    Family family = Family::EdgeCollapse;
    bool expands = false; // works on the de-instanced scene
    std::vector<ParameterInfo> parameters;
    // The slow part. values validated against parameters by the callee: Usage error.
    // Cancellable within 10 ms, deterministic for any number of threads. Any thread.
    Result<LodSourcePtr> (*prepare)(const ScenePtr& scene,
                                    const ParameterValues& values,
                                    const ScheduleOptions& schedule,
                                    const JobContext& job) = nullptr;
    // The same for the scene of another row's source: what does not depend on the parameters is
    // taken from it, so that a slider of a one-shot method need not weld the scene again. Null
    // where rows share nothing.
    Result<LodSourcePtr> (*prepareLike)(const LodSource& other,
                                        const ParameterValues& values,
                                        const ScheduleOptions& schedule,
                                        const JobContext& job) = nullptr;
};

std::span<const Algorithm> algorithms();
const Algorithm* findAlgorithm(std::string_view id); // nullptr if unknown

// The value of a parameter, its default where missing.
double
parameterValue(const Algorithm& algorithm, const ParameterValues& values, std::string_view id);
// Usage error naming a parameter that the algorithm has not, or whose value is out of its range.
Result<void> checkParameters(const Algorithm& algorithm, const ParameterValues& values);
// Usage error naming the parameter and its range or choices.
Result<double>
parseParameter(const Algorithm& algorithm, std::string_view id, std::string_view text);

} // namespace lodestone
