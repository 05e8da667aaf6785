#pragma once
// Line charts as inline SVG: both axes logarithmic, colours and fonts from the page's style.
#include <optional>
#include <string>
#include <vector>

namespace lodestone {

struct ChartPoint {
    double x = 0.0;
    double y = 0.0;
    std::string label; // shown when pointed at
};

struct ChartSeries {
    std::string name;
    std::string style;              // custom properties that colour it (laneStyle)
    std::size_t number = 0;         // in the legend; chooses the marker's shape
    std::vector<ChartPoint> points; // in the order of the line
    std::optional<ChartPoint> emphasised;
};

enum class ChartUnit : unsigned char { Count, Bytes, Percent };

struct ChartAxis {
    std::string label; // with unit
    ChartUnit unit = ChartUnit::Count;
};

struct ChartReference { // a horizontal line
    double y = 0.0;
    std::string label;
};

struct Chart {
    std::string title;
    std::string summary; // one sentence for those who cannot see it
    ChartAxis x;
    ChartAxis y;
    std::vector<ChartSeries> series;
    std::optional<ChartReference> reference;
};

// <svg>...</svg>, well-formed XML. Points that no logarithm reaches (<= 0, not finite) are left
// out. Empty if no point remains.
std::string svgChart(const Chart& chart);
// The marker of a series alone, for the legend.
std::string svgMarker(std::size_t number);

} // namespace lodestone
