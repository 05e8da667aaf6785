#include "app/json_text.h"

#include <nlohmann/json.hpp>

namespace lodestone {

std::string jsonText(std::string_view text) {
    return nlohmann::json(std::string(text))
        .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace lodestone
