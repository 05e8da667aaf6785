#pragma once
// The figures, as Markdown.
#include "bench/timing.h"

#include <optional>
#include <ostream>
#include <string>

namespace lodestone::bench {

// One line of the table.
struct Figure {
    std::string what;
    std::string measured;
    std::string against; // what it is compared with
    std::string target;
    std::string ratio;
    std::optional<bool> met; // empty: told for information
};

class Table {
public:
    explicit Table(std::ostream& out) : out_(&out) {}

    void heading(const std::string& title);
    void add(const Figure& figure);

    int met() const { return met_; }

    const std::vector<std::string>& missed() const { return missed_; } // with the headings

    // For information.
    void
    tell(const std::string& what, const std::string& measured, const std::string& against = "");

    // value <= limit; both already as text as well. NaN never meets a target.
    struct Limit {
        double value = 0.0;
        double limit = 0.0;
        std::string value_text;
        std::string limit_text;
        std::string against;
    };

    void atMost(const std::string& what, const Limit& limit);

    // ratio <= or >= limit, of two measured things.
    struct Ratio {
        double ratio = 0.0;
        double limit = 0.0;
        std::string measured;
        std::string against;
    };

    void ratioAtMost(const std::string& what, const Ratio& ratio);
    void ratioAtLeast(const std::string& what, const Ratio& ratio);

private:
    std::ostream* out_;
    std::string title_;
    int met_ = 0;
    std::vector<std::string> missed_;
};

std::string secondsText(double seconds);       // "12.3 ms", "1.37 s"
std::string secondsText(const Spread& spread); // median (min–max)
std::string percentText(double percent);       // of the diagonal
std::string countText(std::uint64_t count);    // 1,818,074
std::string megabytesText(std::uint64_t bytes);

} // namespace lodestone::bench
