#pragma once
// Texts and numbers as the page shows them. The page is well-formed XML besides being HTML.
#include "app/lane.h"

#include <string>
#include <string_view>

namespace lodestone {

// For element content and quoted attributes. Bytes that are not UTF-8, and control characters,
// become U+FFFD.
std::string escaped(std::string_view text);
std::string base64(std::string_view bytes); // RFC 4648, padded

std::string secondsText(double seconds); // "3.2 s", "38 ms", "0.4 ms"
std::string percentText(double percent); // "20 %", "0.52 %": two or three digits
std::string compactCount(double value);  // axis labels: "20 K", "1.8 M"
std::string fixedText(double value, int decimals);
// So many decimals that the smallest of the values that are not 0 shows two digits; 0..5.
int decimalsFor(double smallest);

// Custom properties that colour an element as the algorithm's lanes, on dark and on light.
std::string laneStyle(const Algorithm* algorithm);

} // namespace lodestone
