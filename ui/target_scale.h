#pragma once
// How a target sits on a slider, reads as text, and is typed.
#include "app/document.h"

#include <optional>
#include <string>
#include <string_view>

namespace lodestone::ui {

// What a slider for targets of one kind spans.
struct TargetScale {
    Target::Kind kind = Target::Kind::Ratio;
    double full = 1.0; // value of the untouched scene: 1, triangles, bytes; for Error the largest
    double smallest = 0.0; // > 0: the scale is logarithmic and begins here
};

// largest_bytes: of any lane at full detail, so that the byte slider reaches it.
TargetScale targetScale(const Document& document, Target::Kind kind, std::uint64_t largest_bytes);

double fractionOf(const TargetScale& scale, double value); // 0..1
double valueAt(const TargetScale& scale, double fraction); // inverse, rounded to whole units
// Errors in pixels of a view: 0.1 to 100, logarithmic.
TargetScale pixelScale();
std::string formatPixels(double pixels);          // 1.5 px
std::string formatTarget(const Target& target);   // 20.0 %, 363,615 tri, 341 KiB
std::string editableTarget(const Target& target); // 20, 363615, 341 KiB
// "20", "20 %", "363,615", "1.2M", "341 KiB", "0.5 %". nullopt if it is not a number in range.
std::optional<double> parseTarget(const TargetScale& scale, std::string_view text);

} // namespace lodestone::ui
