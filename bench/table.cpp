#include "bench/table.h"

#include <fmt/core.h>

namespace lodestone::bench {

void Table::heading(const std::string& title) {
    title_ = title;
    *out_ << "\n### " << title << "\n\n"
          << "| what | measured | against | target | ratio | met |\n"
          << "|---|---|---|---|---|---|\n"
          << std::flush;
}

void Table::add(const Figure& figure) {
    const char* met = "";
    if (figure.met && *figure.met) {
        met = "yes";
        ++met_;
    } else if (figure.met) {
        met = "**no**";
        missed_.push_back(fmt::format("{}: {}: {} ({}; target {})",
                                      title_,
                                      figure.what,
                                      figure.measured,
                                      figure.ratio.empty() ? "no ratio" : figure.ratio,
                                      figure.target));
    }
    *out_ << fmt::format("| {} | {} | {} | {} | {} | {} |\n",
                         figure.what,
                         figure.measured,
                         figure.against,
                         figure.target,
                         figure.ratio,
                         met)
          << std::flush;
}

void Table::tell(const std::string& what, const std::string& measured, const std::string& against) {
    add({what, measured, against, "", "", std::nullopt});
}

void Table::atMost(const std::string& what, const Limit& limit) {
    add({what,
         limit.value_text,
         limit.against,
         "≤ " + limit.limit_text,
         limit.limit != 0.0 ? fmt::format("{:.2f} of it", limit.value / limit.limit) : "",
         limit.value <= limit.limit});
}

void Table::ratioAtMost(const std::string& what, const Ratio& ratio) {
    add({what,
         ratio.measured,
         ratio.against,
         fmt::format("≤ {:.4g}×", ratio.limit),
         fmt::format("{:.3g}×", ratio.ratio),
         ratio.ratio <= ratio.limit});
}

void Table::ratioAtLeast(const std::string& what, const Ratio& ratio) {
    add({what,
         ratio.measured,
         ratio.against,
         fmt::format("≥ {:.4g}×", ratio.limit),
         fmt::format("{:.3g}×", ratio.ratio),
         ratio.ratio >= ratio.limit});
}

std::string secondsText(double seconds) {
    if (seconds < 1.0)
        return fmt::format("{:.3g} ms", 1e3 * seconds);
    return fmt::format("{:.3g} s", seconds);
}

std::string secondsText(const Spread& spread) {
    return fmt::format(
        "{} ({}–{})", secondsText(spread.median), secondsText(spread.min), secondsText(spread.max));
}

std::string percentText(double percent) {
    return fmt::format("{:.4f} %", percent);
}

std::string countText(std::uint64_t count) {
    std::string digits = std::to_string(count);
    for (std::size_t i = digits.size(); i > 3; i -= 3)
        digits.insert(i - 3, ",");
    return digits;
}

std::string megabytesText(std::uint64_t bytes) {
    return fmt::format("{:.3f} MB", 1e-6 * static_cast<double>(bytes));
}

} // namespace lodestone::bench
