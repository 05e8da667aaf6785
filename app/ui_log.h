#pragma once
// JSON lines of what is on screen, so that tests of the window wait for state and never for time.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>

namespace lodestone {

// Appends a line whenever something differs from the last time it was written, and flushes it.
// Without a file every call is a no-op. Main thread.
class UiLog {
public:
    UiLog() = default;
    explicit UiLog(const std::filesystem::path& file); // empty: off

    bool enabled() const { return stream_.is_open(); }

    // {"kind":"widget","name":"Window/label","rect":[x,y,width,height],"enabled":true}, in pixels
    // from the window's top left corner.
    void widget(std::string_view name, float x, float y, float width, float height, bool enabled);
    // {"kind":"frame","number":N,...}: one a drawn frame, so that a test knows a picture is out.
    void frame(std::uint64_t number);
    // Any other object: kind and key name it, members is the inside of a JSON object ("\"a\":1").
    void object(std::string_view kind, std::string_view key, std::string_view members);

private:
    void write(const std::string& key, const std::string& line);

    std::ofstream stream_;
    std::map<std::string, std::string, std::less<>> last_; // key -> line
};

} // namespace lodestone
