#pragma once
#include "scene/gltf/source_document.h"
#include "scene/job_context.h"
#include "scene/result.h"

#include <optional>
#include <string>

namespace lodestone {

// What every part of the glTF reader gets: the validated document and the scene being filled.
struct ReadContext {
    std::string file; // name without folder: the head of every message
    SourceDocument& document;
    Scene& scene;
    const JobContext& job;

    tl::unexpected<Error> bad(const std::string& what) const {
        return badInput(file + ": " + what);
    }

    void note(std::string text) const { scene.notes.push_back(std::move(text)); }
};

// A list of the document, or an empty one.
const nlohmann::json& listOf(const nlohmann::json& document, std::string_view name);

// A member of an object, or null: for what validateDocument() has not looked at (extensions).
const nlohmann::json* member(const nlohmann::json& object, std::string_view key);
const nlohmann::json* extension(const nlohmann::json& object, std::string_view name);

// A whole number >= 0 (24.0 counts), else nothing.
std::optional<std::uint64_t> asUnsigned(const nlohmann::json& value);
std::optional<std::uint64_t> unsignedMember(const nlohmann::json& object, std::string_view key);
double numberMember(const nlohmann::json& object, std::string_view key, double otherwise);
std::string stringMember(const nlohmann::json& object, std::string_view key);

// "mesh 3 'leaf'"; the name is cut short and cleared of control characters.
std::string label(std::string_view kind, std::size_t index, const std::string& name);

} // namespace lodestone
