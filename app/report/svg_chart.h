#pragma once
// Line charts as inline SVG: colours and fonts from the page's style.
#include <optional>
#include <string>
#include <vector>

namespace lodestone {

struct ChartPoint {
    double x = 0.0;
    double y = 0.0;
    std::string label; // shown when pointed at
};

enum class ChartMarks : unsigned char { Points, None }; // None: for lines of very many points

struct ChartSeries {
    std::string name;
    std::string style;              // custom properties that colour it (laneStyle)
    std::size_t number = 0;         // in the legend; chooses the marker's shape
    std::vector<ChartPoint> points; // in the order of the line
    std::optional<ChartPoint> emphasised;
    ChartMarks marks = ChartMarks::Points;
};

enum class ChartUnit : unsigned char { Count, Bytes, Percent };
enum class ChartScale : unsigned char { Logarithmic, Linear };

struct ChartAxis {
    std::string label; // with unit
    ChartUnit unit = ChartUnit::Count;
    ChartScale scale = ChartScale::Logarithmic;
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

// <svg>...</svg>, well-formed XML. Points that are not finite, or that a logarithmic axis does not
// reach (<= 0), are left out. Empty if no point remains.
std::string svgChart(const Chart& chart);
// The marker of a series alone, for the legend.
std::string svgMarker(std::size_t number);

} // namespace lodestone
