#pragma once
// A peer sheet as it is kept between runs.
#include "bench/peer_sheet.h"

#include <nlohmann/json.hpp>

namespace lodestone::bench {

// What is not finite is null.
nlohmann::json sheetJson(const PeerSheet& sheet);
// Of what sheetJson made. Throws nlohmann::json::exception for anything else.
PeerSheet sheetOf(const nlohmann::json& json);

} // namespace lodestone::bench
