#pragma once
// What commands print: JSON objects, and text for people.
#include "app/cli_run.h"

#include <nlohmann/json_fwd.hpp>

namespace lodestone {

std::string thousands(std::uint64_t value);  // 1,818,074
std::string humanBytes(std::uint64_t bytes); // 312 B, 41.2 KB, 1.82 MB (powers of 1000)

// What --json tells of an outcome, as the contract names it.
nlohmann::ordered_json outcomeObject(const RunOutcome& outcome);
// One object, ends with a line break.
std::string outcomeJson(const RunOutcome& outcome);
// What simplify tells people: counts before and after, size, seconds, notes.
std::string outcomeText(const RunOutcome& outcome, const SceneCounts& before);
std::string distanceJson(const Distance& distance);
std::string distanceText(const Distance& distance);
std::string algorithmsJson();
std::string algorithmsText();
// The parameters of every algorithm, for `simplify --help`.
std::string parametersText();

} // namespace lodestone
