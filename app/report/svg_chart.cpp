#include "app/report/svg_chart.h"

#include "app/cli_report.h"
#include "app/report/html_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/core.h>
#include <limits>
#include <numeric>
#include <span>

namespace lodestone {

namespace {

constexpr double kWidth = 560.0;
constexpr double kHeight = 350.0;
constexpr double kLeft = 64.0;
constexpr double kRight = 12.0;
constexpr double kTop = 12.0;
constexpr double kBottom = 48.0;

bool drawable(double value, ChartScale scale) {
    return std::isfinite(value) && (scale == ChartScale::Linear || value > 0.0);
}

bool drawable(const Chart& chart, const ChartPoint& point) {
    return drawable(point.x, chart.x.scale) && drawable(point.y, chart.y.scale);
}

// An axis that fills pixels first..last. Its own coordinates are values or their logarithms.
class AxisScale {
public:
    AxisScale(ChartScale scale, double first_px, double last_px)
        : scale_(scale), first_px_(first_px), last_px_(last_px) {}

    void add(double value) {
        low_ = std::min(low_, onAxis(value));
        high_ = std::max(high_, onAxis(value));
    }

    void finish() {
        constexpr double kPadding = 0.05; // of the length
        constexpr double kShortest = 0.1; // decades
        const double middle = 0.5 * (low_ + high_);
        const double half = std::max(0.5 * (high_ - low_), kShortest) * (1.0 + 2 * kPadding);
        low_ = middle - half;
        high_ = middle + half;
    }

    double px(double value) const {
        const double share = (onAxis(value) - low_) / (high_ - low_);
        return first_px_ + share * (last_px_ - first_px_);
    }

    // Round values, as many as fit without crowding.
    std::vector<double> ticks() const {
        return scale_ == ChartScale::Linear ? evenTicks() : decadeTicks();
    }

private:
    static constexpr std::size_t kMostTicks = 8;

    double onAxis(double value) const {
        return scale_ == ChartScale::Linear ? value : std::log10(value);
    }

    std::vector<double> evenTicks() const {
        double step = std::pow(10.0, std::floor(std::log10(high_ - low_)) - 1.0);
        for (const double factor : {2.0, 2.5, 2.0, 2.0, 2.5})
            if ((high_ - low_) / step > kMostTicks)
                step *= factor;
        std::vector<double> found;
        const double first = std::ceil(low_ / step) + 0.0; // -0 + 0 is 0
        for (double count = first; count * step <= high_; count += 1.0)
            found.push_back(count * step);
        return found;
    }

    std::vector<double> decadeTicks() const {
        static constexpr std::array<int, 9> kOnes = {10, 20, 30, 40, 50, 60, 70, 80, 90};
        static constexpr std::array<int, 3> kFew = {10, 20, 50};
        std::array<int, 90> tenths{};
        std::iota(tenths.begin(), tenths.end(), 10);
        for (const std::span<const int> digits : {std::span<const int>(tenths),
                                                  std::span<const int>(kOnes),
                                                  std::span<const int>(kFew)})
            if (std::vector<double> found = ticksOf(digits); found.size() <= kMostTicks)
                return found;
        return ticksOf(std::span(kFew).first(1));
    }

    // tenths: of the ticks within every decade, 10..99.
    std::vector<double> ticksOf(std::span<const int> tenths) const {
        std::vector<double> found;
        const int first = static_cast<int>(std::floor(low_));
        const int last = static_cast<int>(std::ceil(high_));
        for (int decade = first; decade <= last; ++decade)
            for (const int tenth : tenths) {
                const double value = 0.1 * tenth * std::pow(10.0, decade);
                if (std::log10(value) >= low_ && std::log10(value) <= high_)
                    found.push_back(value);
            }
        return found;
    }

    ChartScale scale_;
    double first_px_;
    double last_px_;
    double low_ = std::numeric_limits<double>::max();
    double high_ = std::numeric_limits<double>::lowest();
};

// The area that the series share.
struct Plot {
    AxisScale x;
    AxisScale y;
};

std::string tickText(double value, ChartUnit unit) {
    switch (unit) {
    case ChartUnit::Bytes:
        return compactCount(value) + "B";
    case ChartUnit::Percent:
        return fmt::format("{:g} %", value);
    case ChartUnit::Count:
        break;
    }
    return compactCount(value);
}

// Shapes of about equal weight around the origin, told apart without colour.
constexpr std::array<std::string_view, 8> kMarkers = {
    "M-4 0A4 4 0 1 0 4 0A4 4 0 1 0-4 0Z",                          // circle
    "M-3.5-3.5H3.5V3.5H-3.5Z",                                     // square
    "M0-4.6L4.4 3.2H-4.4Z",                                        // triangle
    "M0-5L5 0L0 5L-5 0Z",                                          // diamond
    "M0 4.6L4.4-3.2H-4.4Z",                                        // triangle, point down
    "M-1.6-4.4H1.6V-1.6H4.4V1.6H1.6V4.4H-1.6V1.6H-4.4V-1.6H-1.6Z", // plus
    "M-4.4-2.6V2.6L0 5L4.4 2.6V-2.6L0-5Z",                         // hexagon
    "M-5-2.4H5V2.4H-5Z"};                                          // bar

std::string marker(const ChartSeries& series, const ChartPoint& point, double x, double y) {
    return fmt::format("<path class=\"marker\" transform=\"translate({:.1f} {:.1f})\" d=\"{}\">"
                       "<title>{}</title></path>",
                       x,
                       y,
                       kMarkers[series.number % kMarkers.size()],
                       escaped(series.name + "\n" + point.label));
}

std::string seriesGroup(const Chart& chart, const ChartSeries& series, const Plot& plot) {
    const auto& [x, y] = plot;
    std::string line;
    std::string markers;
    for (const ChartPoint& point : series.points) {
        if (!drawable(chart, point))
            continue;
        line +=
            fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", x.px(point.x), y.px(point.y));
        if (series.marks == ChartMarks::Points)
            markers += marker(series, point, x.px(point.x), y.px(point.y));
    }
    if (series.emphasised && drawable(chart, *series.emphasised)) {
        const double at_x = x.px(series.emphasised->x);
        const double at_y = y.px(series.emphasised->y);
        markers +=
            fmt::format("<circle class=\"halo\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"8\"/>", at_x, at_y);
        markers += marker(series, *series.emphasised, at_x, at_y);
    }
    if (markers.empty() && line.empty())
        return {};
    return fmt::format(
        "<g class=\"series lane\" data-series=\"{}\" style=\"{}\"><path class=\"line\" "
        "d=\"{}\"/>{}</g>\n",
        series.number,
        escaped(series.style),
        line.empty() ? "M0 0" : line,
        markers);
}

std::string gridLines(const Chart& chart, const Plot& plot) {
    const auto& [x, y] = plot;
    std::string text;
    for (const double value : x.ticks())
        text += fmt::format("<path class=\"grid\" d=\"M{0:.1f} {1}V{2}\"/><text class=\"tick\" "
                            "x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>\n",
                            x.px(value),
                            kTop,
                            kHeight - kBottom,
                            kHeight - kBottom + 17.0,
                            tickText(value, chart.x.unit));
    for (const double value : y.ticks())
        text += fmt::format("<path class=\"grid\" d=\"M{0} {1:.1f}H{2}\"/><text class=\"tick\" "
                            "x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
                            kLeft,
                            y.px(value),
                            kWidth - kRight,
                            kLeft - 8.0,
                            y.px(value) + 4.0,
                            tickText(value, chart.y.unit));
    return text +
           fmt::format("<text class=\"axis\" x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>\n",
                       kWidth - kRight,
                       kHeight - 8.0,
                       escaped(chart.x.label));
}

// Whether the label of a line at `reference` is clearer of the series at the right end.
bool roomierOnTheRight(const Chart& chart, const Plot& plot, double reference_px) {
    const auto& [x, y] = plot;
    constexpr double kLabelPx = 150.0;
    double left = kHeight; // to the nearest point
    double right = kHeight;
    for (const ChartSeries& series : chart.series)
        for (const ChartPoint& point : series.points) {
            if (!drawable(chart, point))
                continue;
            const double apart = std::abs(y.px(point.y) - reference_px);
            if (x.px(point.x) < kLeft + kLabelPx)
                left = std::min(left, apart);
            if (x.px(point.x) > kWidth - kRight - kLabelPx)
                right = std::min(right, apart);
        }
    return right > left;
}

std::string referenceLine(const Chart& chart, const Plot& plot) {
    const double at = plot.y.px(chart.reference->y);
    const bool right = roomierOnTheRight(chart, plot, at);
    // Above the line where there is room, else below.
    const double text_y = at > kTop + 18.0 ? at - 6.0 : at + 15.0;
    return fmt::format(
        "<path class=\"reference\" d=\"M{} {:.1f}H{}\"/><text class=\"reference-label\" "
        "x=\"{}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n",
        kLeft,
        at,
        kWidth - kRight,
        right ? kWidth - kRight - 6.0 : kLeft + 6.0,
        text_y,
        right ? "end" : "start",
        escaped(chart.reference->label));
}

} // namespace

std::string svgChart(const Chart& chart) {
    Plot plot{AxisScale(chart.x.scale, kLeft, kWidth - kRight),
              AxisScale(chart.y.scale, kHeight - kBottom, kTop)};
    bool empty = true;
    const auto add = [&](const ChartPoint& point) {
        if (!drawable(chart, point))
            return;
        plot.x.add(point.x);
        plot.y.add(point.y);
        empty = false;
    };
    for (const ChartSeries& series : chart.series) {
        std::ranges::for_each(series.points, add);
        if (series.emphasised)
            add(*series.emphasised);
    }
    if (empty)
        return {};
    if (chart.reference)
        plot.y.add(chart.reference->y);
    plot.x.finish();
    plot.y.finish();
    std::string text =
        fmt::format("<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n",
                    kWidth,
                    kHeight,
                    escaped(chart.title + ". " + chart.summary));
    text += gridLines(chart, plot);
    for (const ChartSeries& series : chart.series)
        text += seriesGroup(chart, series, plot);
    if (chart.reference)
        text += referenceLine(chart, plot);
    return text + "</svg>\n";
}

std::string svgMarker(std::size_t number) {
    return fmt::format("<svg class=\"key\" viewBox=\"-7 -7 14 14\" aria-hidden=\"true\"><path "
                       "class=\"marker\" d=\"{}\"/></svg>",
                       kMarkers[number % kMarkers.size()]);
}

} // namespace lodestone
