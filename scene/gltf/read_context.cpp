#include "scene/gltf/read_context.h"

#include <algorithm>
#include <cmath>

namespace lodestone {

using nlohmann::json;

const json& listOf(const json& document, std::string_view name) {
    static const json empty = json::array();
    const json* list = member(document, name);
    return list != nullptr && list->is_array() ? *list : empty;
}

const json* member(const json& object, std::string_view key) {
    if (!object.is_object())
        return nullptr;
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &*found;
}

const json* extension(const json& object, std::string_view name) {
    const json* extensions = member(object, "extensions");
    return extensions == nullptr ? nullptr : member(*extensions, name);
}

std::optional<std::uint64_t> asUnsigned(const json& value) {
    if (value.is_number_unsigned())
        return value.get<std::uint64_t>();
    if (value.is_number_float()) {
        const double number = value.get<double>();
        if (number >= 0.0 && number < 9007199254740992.0 && std::floor(number) == number)
            return static_cast<std::uint64_t>(number);
    }
    return std::nullopt;
}

std::optional<std::uint64_t> unsignedMember(const json& object, std::string_view key) {
    const json* value = member(object, key);
    return value == nullptr ? std::nullopt : asUnsigned(*value);
}

double numberMember(const json& object, std::string_view key, double otherwise) {
    const json* value = member(object, key);
    return value != nullptr && value->is_number() ? value->get<double>() : otherwise;
}

std::string stringMember(const json& object, std::string_view key) {
    const json* value = member(object, key);
    return value != nullptr && value->is_string() ? value->get<std::string>() : std::string();
}

std::string label(std::string_view kind, std::size_t index, const std::string& name) {
    std::string text = std::string(kind) + " " + std::to_string(index);
    if (name.empty())
        return text;
    std::string shown = name.substr(0, 60);
    std::ranges::replace_if(
        shown, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
    return text + " '" + shown + "'";
}

} // namespace lodestone
