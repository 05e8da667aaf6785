#include "app/ui_log.h"

#include "app/json_text.h"

#include <fmt/core.h>

namespace lodestone {

UiLog::UiLog(const std::filesystem::path& file) {
    if (!file.empty())
        stream_.open(file, std::ios::app);
}

void UiLog::widget(
    std::string_view name, float x, float y, float width, float height, bool enabled) {
    if (!this->enabled())
        return;
    object(
        "widget",
        name,
        fmt::format(
            "\"rect\":[{:.1f},{:.1f},{:.1f},{:.1f}],\"enabled\":{}", x, y, width, height, enabled));
}

void UiLog::frame(std::uint64_t number) {
    if (enabled())
        write("frame", fmt::format("{{\"kind\":\"frame\",\"number\":{}}}", number));
}

void UiLog::object(std::string_view kind, std::string_view key, std::string_view members) {
    if (!enabled())
        return;
    const std::string_view comma = members.empty() ? "" : ",";
    write(fmt::format("{}/{}", kind, key),
          fmt::format(
              "{{\"kind\":{},\"name\":{}{}{}}}", jsonText(kind), jsonText(key), comma, members));
}

void UiLog::write(const std::string& key, const std::string& line) {
    std::string& last = last_[key];
    if (last == line)
        return;
    last = line;
    stream_ << line << '\n' << std::flush;
}

} // namespace lodestone
