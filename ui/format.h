#pragma once
// Numbers as the window writes them: separators, units, a dash for what is not known yet.
#include <cstdint>
#include <string>

namespace lodestone::ui {

inline constexpr const char* kUnknown = "\u2013"; // en dash

std::string formatCount(std::uint64_t count);          // 1 818 074, thin spaces
std::string formatShortCount(std::uint64_t count);     // 1.82 M, 363 K, 940
std::string formatBytes(std::uint64_t size_bytes);     // 2.93 MiB, 341 KiB, 512 B
std::string formatRatio(double ratio);                 // 0.2 -> 20.0 %
std::string formatChange(double before, double after); // - 88.4 %, + 12.0 %
std::string formatSeconds(double time_s);              // 0.10 s, 2.1 s, 1 min 12 s
std::string formatMilliseconds(double time_ms);        // 8.9 ms
std::string formatRate(double frames_per_second);      // 144, 2.3
std::string formatError(double error_rel_percent);     // 0.0048, 0.073

} // namespace lodestone::ui
